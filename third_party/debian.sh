# Nacre: installs the Debian packages that a build needs. Sourced by ./dev; never removes a package, asks nothing.

required_packages=(
  g++ cmake ninja-build
  libtbb-dev libfmt-dev libpugixml-dev zlib1g-dev libcli11-dev nlohmann-json3-dev
  libtinyobjloader-dev libstb-dev libteem-dev libnifti2-dev libcgal-dev libgtest-dev
  ffmpeg fonts-dejavu-core
)
optional_packages=(ccache)
qhull_packages=(libqhull-dev)
viewer_packages=(libglfw3-dev libglew-dev libegl-dev libglm-dev libimgui-dev libgl1-mesa-dri xvfb xauth xdotool)
vtk_packages=(libvtk9-dev)
dicom_packages=(libgdcm-dev)
hdf5_packages=(libhdf5-dev)
mpi_packages=(libopenmpi-dev openmpi-bin)
every_package=("${required_packages[@]}" "${optional_packages[@]}" "${qhull_packages[@]}" "${viewer_packages[@]}"
  "${vtk_packages[@]}" "${dicom_packages[@]}" "${hdf5_packages[@]}" "${mpi_packages[@]}")  # of a build
check_packages=(clang-format clang-tidy)

apt_options=(-y -q --no-install-recommends --no-remove -o DPkg::Lock::Timeout=120
  -o Dpkg::Options::=--force-confdef -o Dpkg::Options::=--force-confold)

is_installed() {
  [[ $(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# Prints those of the given packages that are not installed, one per line.
missing_packages() {
  local status name
  declare -A installed=()
  while read -r name status; do
    [[ $status == installed ]] && installed[$name]=1
  done < <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "$@" 2>/dev/null)
  for name in "$@"; do
    [[ -v installed[$name] ]] || echo "$name"
  done
}

can_be_root() {
  ((EUID == 0)) || sudo -n true 2>/dev/null
}

apt_as_root() {
  local prefix=()
  ((EUID == 0)) || prefix=(sudo -n)
  "${prefix[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get "$@"
}

# Prints what apt would do; fails if it cannot (an unknown package, or lists never fetched).
simulate_install() {
  LC_ALL=C apt-get install -s -y --no-install-recommends "$@" 2>&1
}

# install_packages NAME...: 0 all are installed, 1 apt failed, 2 something would have been removed.
install_packages() {
  local plan
  say "installing: $*"
  if ! plan=$(simulate_install "$@"); then
    apt_as_root update -q || return 1
    plan=$(simulate_install "$@") || { echo "$plan" >&2; return 1; }
  fi
  if grep -q '^Remv ' <<<"$plan"; then
    say "not installed, because these would have to go: $(sed -n 's/^Remv \([^ ]*\).*/\1/p' <<<"$plan" | xargs)"
    return 2
  fi
  apt_as_root install "${apt_options[@]}" "$@" && return
  # The package lists may be out of date.
  apt_as_root update -q && apt_as_root install "${apt_options[@]}" "$@" || return 1
}

# require_packages NAME...: installs the missing ones, or ends with the command that does.
require_packages() {
  local missing
  mapfile -t missing < <(missing_packages "$@")
  ((${#missing[@]})) || return 0
  if ! can_be_root; then
    fail "packages are missing and this user may not install them; run: sudo apt-get install --no-install-recommends ${missing[*]}"
  fi
  install_packages "${missing[@]}" ||
    fail "packages could not be installed; see above, then run: apt-get install --no-install-recommends ${missing[*]}"
}

# prefer_packages WHAT NAME...: installs the missing ones if nothing prevents it; never fails.
prefer_packages() {
  local what=$1 missing
  shift
  mapfile -t missing < <(missing_packages "$@")
  ((${#missing[@]})) || return 0
  if ! can_be_root; then
    say "without $what (${missing[*]} not installed)"
  else
    install_packages "${missing[@]}" || say "without $what (${missing[*]} could not be installed)"
  fi
}

# VTK reads further formats, but cannot be installed together with ParaView's Python package.
prefer_vtk() {
  [[ ${NACRE_VTK:-AUTO} != OFF ]] || return 0
  if is_installed python3-paraview && ! is_installed libvtk9-dev; then
    say "without VTK's formats (libvtk9-dev would push out python3-paraview)"
    return 0
  fi
  prefer_packages "VTK's formats" "${vtk_packages[@]}"
}

# The window needs packages that a headless machine can do without.
prefer_viewer() {
  [[ ${NACRE_VIEWER:-AUTO} != OFF ]] || return 0
  prefer_packages "the viewer" "${viewer_packages[@]}"
}
