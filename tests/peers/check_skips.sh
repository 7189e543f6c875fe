#!/usr/bin/env bash
# Nacre: peers that are missing are skipped aloud, and that is no failure. Usage: check_skips.sh BUILD, the build folder.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
said=$(PEERS_PYTHON=/bin/false PVPYTHON=/nonexistent NACRE_BUILD=${1:?usage: check_skips.sh BUILD} \
  bash "$here/run.sh" surface_nets ftetwild surface_lic 2>&1) || { echo "$said"; echo "run.sh failed"; exit 1; }
for peer in surface_nets ftetwild surface_lic; do
  grep -q "^run.sh: $peer is skipped: " <<<"$said" || { echo "$said"; echo "run.sh does not say that $peer is skipped"; exit 1; }
done
echo "all three are skipped aloud"
