# SPDX-License-Identifier: BSD-3-Clause
"""Self-calibrating 3D point clouds from spinning 2D lasers.

    import crisp
    result = crisp.run("calibrate", input="hub.pcap", output="out")
    result.cloud["x"]            # numpy, without a copy
    result.calibration["lasers"]
"""

import dataclasses
import json
import os
import typing
import warnings

import numpy

from . import _crisp

__all__ = ["Error", "NotTrustedWarning", "Result", "rqe", "run"]
__version__ = _crisp.version

_Path = typing.Union[str, os.PathLike]


class Error(Exception):
    """What is wrong, where, and what to do.

    message, advice: texts; file, line, column: the place in a file that a person wrote ("", 0, 0 where there is
    none); all: the errors, where several were found at once, of which these are those of the first.
    """

    def __init__(self, details: dict):
        self.all = [Error(each) for each in details.get("all", [])] or [self]
        first = details["all"][0] if details.get("all") else details
        self.message: str = first["message"]
        self.advice: str = first["advice"]
        self.file: str = first["file"]
        self.line: int = first["line"]
        self.column: int = first["column"]
        super().__init__("\n".join(error._text() for error in self.all))

    def _text(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part)
        return ": ".join(part for part in (place, self.message) if part) + (f"; {self.advice}" if self.advice else "")


class NotTrustedWarning(UserWarning):
    """A run came to its end, but its result is untrusted: the text states the caveats."""


@dataclasses.dataclass(frozen=True)
class Result:
    """What a run gave: of each kind what the last stage that gives it gave; None where no stage does."""

    cloud: typing.Optional[numpy.ndarray]
    """n rows x, y, z [m, the plate's frame], intensity, laser, beam, time [s since the epoch]; read-only"""
    measurements: typing.Optional[numpy.ndarray]
    """n rows time [s since the epoch], range [m], mirror_angle [rad], remission, laser, beam; read-only"""
    calibration: typing.Optional[dict]
    """as in calibration.yaml"""
    diagnosis: typing.Optional[dict]
    """as in diagnosis.json"""
    epoch_ns: int
    """[ns since the Unix epoch] zero of the times of points and measurements"""
    summary: dict
    """as in summary.json"""

    @property
    def trusted(self) -> bool:
        """Whether no stage had a caveat."""
        return self.summary["trusted"]

    @property
    def caveats(self) -> list:
        """Why the result is not to be trusted."""
        return [caveat for stage in self.summary["stages"] for caveat in stage["caveats"]]


def run(
    pipeline: typing.Union[_Path, dict],
    *,
    input: typing.Optional[_Path] = None,
    output: typing.Optional[_Path] = None,
    rig: typing.Optional[_Path] = None,
    set: typing.Optional[dict] = None,
    plugins: typing.Sequence[_Path] = (),
    threads: typing.Optional[int] = None,
    seed: int = 1,
) -> Result:
    """Runs a pipeline to its end.

    pipeline: a YAML file, the name of an installed pipeline ("calibrate"), or what such a file holds as a dict
    input, output, rig, set: as on the command line, `set` as a dict: {"grabber.simulate.duration": "4s"}
    threads: None: one a core. The result does not depend on it.

    Other threads of Python run meanwhile. Raises Error, KeyboardInterrupt; warns by NotTrustedWarning.
    """
    text = json.dumps(pipeline, indent=1) if isinstance(pipeline, dict) else ""
    settings = [f"{name}={value if isinstance(value, str) else json.dumps(value)}" for name, value in (set or {}).items()]
    results = _crisp.run(
        pipeline="<dict>" if text else os.fspath(pipeline),
        text=text,
        input=input,
        output=output,
        rig=rig,
        set=settings,
        plugins=list(plugins),
        threads=threads,
        seed=seed,
    )
    result = Result(**results)
    if not result.trusted:
        warnings.warn("not to be trusted: " + "; ".join(result.caveats), NotTrustedWarning, stacklevel=2)
    return result


def rqe(points: numpy.ndarray, sigma: float = 0.03) -> typing.Tuple[float, numpy.ndarray]:
    """Rényi's quadratic entropy of a cloud [nat] (lower is sharper), and its gradient by the points [1/m].

    points: n rows x, y, z [m]; sigma: [m] width of the kernel
    """
    return _crisp.rqe(points, sigma)
