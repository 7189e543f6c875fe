# Nacre: a Debian of its own, in a folder, for what must not be installed on this machine. Sourced by test scripts.

skip() {
  echo "skipped: $*"
  exit 77
}

# make_debian ROOT LOG PACKAGE...: debootstrap, then the packages. What is there is kept; what was left half made is made
# again. Skips, and says why, where root, debootstrap or the network is missing.
make_debian() {
  local root=$1 log=$2 mirror=${NACRE_DEBIAN_MIRROR:-http://deb.debian.org/debian}
  shift 2
  ((EUID == 0)) || skip "only root can change into another root folder"
  command -v debootstrap >/dev/null || skip "debootstrap is not installed; apt-get install debootstrap"
  [[ -e $root.made && $(<"$root.made") == "$*" ]] && return
  rm -rf --one-file-system "$root" "$root.made"
  debootstrap --variant=minbase --include=ca-certificates bookworm "$root" "$mirror" >"$log" 2>&1 ||
    skip "debootstrap cannot make a Debian from $mirror; see $log"
  in_debian "$root" apt-get install -y -q --no-install-recommends "$@" >>"$log" 2>&1 ||
    skip "$* cannot be installed in it; see $log"
  echo "$*" >"$root.made"
}

# in_debian ROOT COMMAND...: with /dev and /proc, which are let go afterwards.
in_debian() (
  root=$1
  mount --bind /dev "$root/dev" && mount -t proc proc "$root/proc" || skip "/dev and /proc cannot be mounted in $root"
  trap 'umount -l "$root/proc" "$root/dev"' EXIT  # at once, even if a program in there is still ending
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    LIBGL_ALWAYS_SOFTWARE=1 PYTHONPATH=/opt/nacre "${@:2}"
)
