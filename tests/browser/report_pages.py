# SPDX-License-Identifier: BSD-3-Clause
"""The pages that the browser test opens: made by the program, of a simulated recording and of results in a folder."""

import base64
import html
import json
import pathlib
import re
import subprocess
import zlib

ATTACK = "<img src=x onerror=\"window.attacked=1\">"


def run(program, *arguments, status=0):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != status:
        raise RuntimeError(f"crisp {arguments[0]} ended with {done.returncode}: {done.stderr}")


def calibrated(program, source, folder):
    """The report of a calibration of a simulated recording of three seconds."""
    made, out = folder / "made", folder / "out"
    run(program, "run", source / "configs/simulate.yaml", "-o", made, "--quiet", "--set", "grabber.simulate.duration=3s")
    rig = (source / "configs/rig.yaml").read_text()
    (folder / "rig.yaml").write_text(rig)
    run(program, "run", source / "configs/calibrate.yaml", "-i", made / "hub.pcap", "-o", out, "--quiet", "--rig", folder / "rig.yaml")
    return out / "report.html"


def panel_of(covariate, size):
    """The data of a plot, as pipeline/plot/plot_json.hpp has them: y runs from 0 to `size`, and has a gap."""
    return {"title": f"laser2 against {covariate} " + ATTACK, "x_label": f"{covariate} [m]", "y_label": "residual [mm]", "logarithmic": False,
            "series": [{"name": "measured " + ATTACK, "x": [0, 1, 2, 3, 4], "y": [0, size, None, size, size / 2], "joined": True, "error": [0, 0.1, 0, 0, 0]},
                       {"name": "simulated", "x": [0, 4], "y": [0, 0], "joined": True}],
            "kinds": [], "marks": []}


def untrusted(program, folder):
    """The report of a run that has caveats, of a diagnosis with two causes, with markup in every name."""
    folder.mkdir()
    stage = {"tag": "calibrate.refine" + ATTACK, "stage": "calibrate.refine", "seconds": 1.5, "options": {"noise": ATTACK},
             "counts": {"laser1: telegrams lost " + ATTACK: 3}, "warnings": ["a warning " + ATTACK],
             "caveats": ["front and back views agree on 45 % " + ATTACK], "outputs": [str(folder / "laser1_residuals.svg")],
             "report": {"devices": [{"name": "laser1" + ATTACK, "ip": ATTACK, "items": 5, "rate": 50.0}]}}
    summary = {"crisp": "0", "pipeline": ATTACK, "rig": ATTACK, "started": ATTACK, "seconds": 2, "trusted": False, "exit_status": 3,
               "inputs": [{"file": "/tmp/" + ATTACK, "bytes": 5, "sha256": "00"}], "stages": [stage]}
    (folder / "summary.json").write_text(json.dumps(summary))
    finding = {"cause": "mirror.cone", "scope": "laser1" + ATTACK, "accepted": True, "rejection_reason": "", "explained_fraction": 0.5,
               "p_value": 1e-9, "log10_bayes_factor": 12.0, "confounded_with": ["timing.intra_scan " + ATTACK], "resolvable_by": ["both directions"],
               "parameters": [{"name": "kappa", "value": 0.005, "unit": "rad", "std_error": 0.0001}],
               "alternatives": [{"cause": "base.motion", "scope": "plate", "log10_bayes_factor": 12.0}],
               "gain": [{"metric": "cloud thickness", "unit": "m", "before": 0.009, "after": 0.008, "ci95": [-0.0012, -0.0008]}]}
    departure = {"covariate": "mirror angle", "quantity": "range", "scope": "laser1", "amplitude": 0.001, "unit": "m",
                 "p_value": 1e-6, "amplitude_after": 0.0001, "p_value_after": 0.5}
    findings = {"crisp": 1, "findings": [finding, {**finding, "cause": "encoder.eccentricity", "scope": "plate"}], "unnamed": [],
                "departures": [departure], "unobservable": [{"cause": ATTACK, "reason": ATTACK, "combination": ""}], "artifacts": [],
                "devices": [], "noise": [{"laser": "laser1", "ranges": 1000, "sigma": 0.012}], "gain": finding["gain"],
                "goodness_of_fit": {"before_p": 1e-9, "after_p": 0.4}}
    (folder / "diagnosis.json").write_text(json.dumps(findings))
    (folder / "laser1_residuals.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="1280" height="400" onload="window.attacked=1"><script>window.attacked=1</script>'
        '<g transform="translate(0,0)"><text font-size="14">laser1 against mirror angle: 1 mm</text></g>'
        '<g transform="translate(640,0)"><text font-size="14">laser1 against range: 0 mm</text></g></svg>')
    (folder / "laser2_residuals.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="1280" height="400">' +
        "".join(f'<g transform="translate({640 * k},0)"><metadata>{html.escape(json.dumps(panel), quote=False)}</metadata></g>'
                for k, panel in enumerate((panel_of("range", 1), panel_of("time", 10)))) + "</svg>")
    stage["outputs"].append(str(folder / "laser2_residuals.svg"))
    (folder / "summary.json").write_text(json.dumps(summary))
    run(program, "report", folder, "--quiet")
    return folder / "report.html"


def batch(program, folder):
    """The report of a batch of twelve, of which one stands out and one failed."""
    folder.mkdir()
    rows = []
    for i in range(12):
        tau = {"value": 0.2 + (0.004 if i == 7 else 0.00001 * i), "unit": "m", "std_error": 0.0001}
        rows.append({"name": f"day {i}", "status": "failed" if i == 3 else "done", "reasons": ["no plate"] if i == 3 else [],
                     "seconds": 10.0 + i, "begin": 1.7e9 + 86400 * i, "points": 1000 * i, "quality": {"rqe_after": 2.0 + i / 100},
                     "parameters": {} if i == 3 else {"laser1.tau": tau}, "causes": [], "stands_out": ["laser1.tau"] if i == 7 else []})
    rows[5]["name"] = "javascript:window.attacked=1//" + ATTACK.replace("/", "")
    (folder / "batch.json").write_text(json.dumps({
        "crisp": "0", "pipeline": "calibrate.yaml", "counts": {"done": 11, "failed": 1}, "rows": rows,
        "trend": [{"parameter": "laser1.tau", "unit": "m", "median": 0.20005, "std_error": 0.00003,
                   "chi2_per_degree_of_freedom": 3.0, "recordings": 11, "stand_out": ["day 7"]}]}))
    for name in ("day 0", rows[5]["name"]):
        (folder / name).mkdir(parents=True)
        (folder / name / "report.html").write_text("<title>the report of a run</title>")
    run(program, "report", folder, "--quiet")
    return folder / "report.html"


def cloud_of(page):
    """The columns of a page's cloud, decoded by the header in plugins/report/encoded_cloud.hpp; and the data of the page."""
    text = page.read_text()
    data = json.loads(re.search(r'id="report-data">(.*?)</script>', text, re.S).group(1))
    raw = zlib.decompress(base64.b64decode(re.search(r'id="report-cloud">(.*?)</script>', text, re.S).group(1)))
    n, begin, columns = data["cloud"]["points"], 0, {}
    for column in data["cloud"]["columns"]:
        size, number, values = column["bytes"], 0, []
        planes = [raw[begin + b * n:begin + (b + 1) * n] for b in range(size)]
        for parts in zip(*planes):
            stored = sum(part << (8 * b) for b, part in enumerate(parts))
            number = (number + stored) % 256**size if column["delta"] else stored
            is_none = column["gaps"] and number == 256**size - 1
            values.append(None if is_none else column["offset"] + column["step"] * number)
        columns[column["name"]] = values
        begin += size * n
    return columns, data
