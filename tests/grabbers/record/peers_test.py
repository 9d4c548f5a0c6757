#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Captures that crisp writes are whole for Wireshark's programs, and crisp reads what those make of them.

    peers_test.py CRISP
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77  # CTest's SKIP_RETURN_CODE
PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else ""
FLAWS = ("_ws.malformed", "tcp.analysis.lost_segment", "tcp.analysis.retransmission", "tcp.analysis.out_of_order",
         "ip.checksum.status == 0", "tcp.checksum.status == 0", "udp.checksum.status == 0")
CHECKS = ("ip.check_checksum", "tcp.check_checksum", "udp.check_checksum")


def run(*words):
    ended = subprocess.run([str(word) for word in words], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return ended.stdout.decode()


class Peers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        run(PROGRAM, "run", "simulate", "-o", cls.folder, "--set", "grabber.simulate.duration=0.5s")
        cls.capture = cls.folder / "hub.pcap"
        cls.items = cls.items_of(cls.capture)

    @staticmethod
    def items_of(capture):
        """Number of scans or readings of each device."""
        return {device["name"]: device["items"] for device in json.loads(run(PROGRAM, "info", "--json", capture))["devices"]}

    def test_tshark_finds_no_flaw(self):
        options = [word for check in CHECKS for word in ("-o", f"{check}:TRUE")]
        self.assertEqual(run("tshark", "-r", self.capture, *options, "-Y", " or ".join(FLAWS)), "")

    def test_tshark_counts_the_encoder_s_datagrams(self):
        sentences = run("tshark", "-r", self.capture, "-Y", "udp.dstport == 4000", "-T", "fields", "-e", "frame.number")
        self.assertEqual(len(sentences.splitlines()), self.items["plate"])

    def test_editcap_s_pcapng_is_the_same(self):
        made = self.folder / "made.pcapng"
        run("editcap", "-F", "pcapng", self.capture, made)
        self.assertEqual(self.items_of(made), self.items)

    def test_parts_that_mergecap_appends_in_the_wrong_order_are_the_same(self):
        run("editcap", "-c", "200", self.capture, self.folder / "part.pcap")
        parts = sorted(self.folder.glob("part_*.pcap"))
        self.assertGreater(len(parts), 2)
        made = self.folder / "merged.pcap"
        run("mergecap", "-a", "-F", "nsecpcap", "-w", made, *reversed(parts))
        self.assertEqual(self.items_of(made), self.items)


if __name__ == "__main__":
    if not all(shutil.which(name) for name in ("tshark", "editcap", "mergecap")):
        print("skipped: tshark is not installed")
        sys.exit(SKIPPED)
    unittest.main()
