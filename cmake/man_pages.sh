#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Pages of the manual of what --help prints, the program's and one of each of its commands':
# man_pages.sh PROGRAM VERSION FOLDER. The program is called by its name, crisp.
set -eu
program=$1 version=$2 folder=$3
PATH=$(dirname "$program"):$PATH

# page NAME SUMMARY COMMAND writes NAME.1.gz, under that name, and without the number of this machine's cores.
page() {
  help2man --no-info --no-discard-stderr --version-string="$version" --name="$2" --source="crisp $version" "$3" |
    sed -e "s/^\\.TH [A-Z]*/.TH $(echo "$1" | tr a-z A-Z)/" -e "s/^$3 \\\\-/$1 \\\\-/" -e 's/^\(.*\(threads\|jobs\)\\fR UINT\)=[0-9]*$/\1/' |
    gzip -9n >"$folder/$1.1.gz"
}

rm -rf "$folder"
mkdir -p "$folder"
page crisp "3D point clouds from spinning 2D lasers, self-calibrated" crisp
crisp --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\)  *\(.*\)/\1 \2/p' | while read -r command summary; do
  page "crisp-$command" "$summary" "crisp $command"
done
