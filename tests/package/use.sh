#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# What users do first with installed packages, in a folder with the README's Python and a project of their own.
set -eux
cd /tmp/work

# The main job, by the names of installed pipelines
crisp run simulate -o made --quiet
crisp calibrate made/hub.pcap -o out --quiet
crisp info made/truth.yaml out/calibration.yaml
test -s out/cloud.pcd
test -s out/report.html

# Python, as the README shows it
ln -s made/hub.pcap hub.pcap
python3 readme.py

# The manual, the documentation and the completion
man -P cat crisp | grep -q calibrate
man -P cat crisp-run | grep -q -e --rig
test -s /usr/share/doc/crisp/README.md
bash -c 'source /usr/share/bash-completion/completions/crisp
COMP_WORDS=(crisp run picture --set calibrati) COMP_CWORD=4; _crisp; test "${COMPREPLY[*]}" = calibration='

# A plugin, and programs that use the libraries
cmake -G Ninja -S examples -B build >/dev/null
cmake --build build -- --quiet
crisp plugins --plugin build/example.so | grep -q example.near
crisp run examples/near.yaml -i examples/cloud.pcd -o near --plugin build/example.so --quiet
grep -q '^POINTS 2$' near/near.pcd
build/cloud_entropy examples/cloud.pcd 4
build/count_scans hub.pcap
