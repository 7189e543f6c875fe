#!/usr/bin/env bash
# Nacre: builds oneTBB with the thread sanitizer, from Debian's source. Usage: instrumented_tbb.sh FOLDER
# The sanitizer does not see what threads hand to each other within a library that is compiled without it, and would
# take most parallel loops for races. FOLDER/prefix/lib gets the library; LD_LIBRARY_PATH makes programs use it. The
# sources and lists of apt stay as they are. Beside it is a libtbbmalloc that calls malloc: the sanitizer knows when
# malloc gives memory to another thread, and oneTBB's own allocator would hide that. Status 77: Debian's source cannot be had.
set -euo pipefail
folder=$1
[[ ! -e $folder/prefix/lib/libtbbmalloc.so.2 ]] || exit 0
mkdir -p "$folder"/{lists/partial,cache/archives/partial,source}
folder=$(cd "$folder" && pwd)

apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Identifier: Packages' 2>/dev/null |
  sort -u >"$folder/sources.list"
apt=(apt-get -q -o "Dir::Etc::SourceList=$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
  -o "Dir::State::Lists=$folder/lists" -o "Dir::Cache=$folder/cache" -o APT::Sandbox::User="$(id -un)")
version=$(dpkg-query -W -f '${source:Version}' libtbb-dev)
(cd "$folder/source" && "${apt[@]}" update && "${apt[@]}" source --download-only "onetbb=$version") >"$folder/apt.log" 2>&1 ||
  { tail -n 3 "$folder/apt.log" >&2; echo "the source of onetbb $version cannot be had" >&2; exit 77; }
tar -xf "$folder"/source/onetbb_*.orig.tar.* -C "$folder/source" --strip-components 1
cmake -S "$folder/source" -B "$folder/build" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_INSTALL_PREFIX="$folder/prefix" \
  -DCMAKE_INSTALL_LIBDIR=lib -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF >"$folder/build.log"
cmake --build "$folder/build" --parallel "$(nproc)" --target install >>"$folder/build.log" 2>&1 ||
  { tail -n 5 "$folder/build.log" >&2; exit 1; }
cc -shared -fPIC -Wl,-soname,libtbbmalloc.so.2 -x c -o "$folder/prefix/lib/libtbbmalloc.so.2" - <<'C'
#include <stdlib.h>
void *scalable_malloc(size_t bytes) { return malloc(bytes); }
void scalable_free(void *memory) { free(memory); }
void *scalable_aligned_malloc(size_t bytes, size_t alignment) {
  void *memory;
  return posix_memalign(&memory, alignment, bytes) == 0 ? memory : NULL;
}
void scalable_aligned_free(void *memory) { free(memory); }
C
