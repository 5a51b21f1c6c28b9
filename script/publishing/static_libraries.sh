#!/usr/bin/env bash
# Builds static versions of the libraries that a self-contained taut contains, from the source packages
# of Debian 12: HDF5 without compression by szip and without tools, NLopt without its LGPL part, SQLite
# without loadable extensions, yaml-cpp, fmt, tinyxml2, libpng, zlib and qrcodegencpp. Takes about three
# minutes on two cores, and does nothing if they are already built.
#
#   script/publishing/static_libraries.sh FOLDER     fills FOLDER/include and FOLDER/lib
set -euo pipefail
[ $# = 1 ] || { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0" >&2; exit 2; }
mkdir -p "$1"
folder=$(cd "$1" && pwd)
names=(hdf5 nlopt yaml-cpp fmtlib tinyxml2 zlib libpng1.6 sqlite3 qr-code-generator)
recipe=$(md5sum <"$0")
[ "$(cat "$folder/made" 2>/dev/null)" != "$recipe" ] || exit 0
# shellcheck source=script/common.sh
source "$(dirname "$0")/../common.sh"
rm -rf "$folder"
mkdir -p "$folder/src" "$folder/include" "$folder/lib"
cd "$folder/src"
log=$folder/log
trap 'status=$?; [ $status = 0 ] || { tail -20 "$log" >&2; echo "static_libraries.sh: failed, see $log" >&2; }' EXIT
exec 3>&1 >"$log" 2>&1

apt_apart "$PWD" deb-src bookworm update
echo "fetching ${names[*]}" >&3
for name in "${names[@]}"; do
  if [ "$name" = qr-code-generator ]; then  # one file, which Debian does not change
    apt_apart "$PWD" deb-src bookworm source --tar-only "$name"
    mkdir "$name" && tar -xf "$name"_*.orig.tar.* --strip-components 1 -C "$name"
    continue
  fi
  apt_apart "$PWD" deb-src bookworm source --download-only "$name"
  dpkg-source --no-check --extract "$name"_*.dsc "$name"
done

# Versions for the bill of materials of a release (sbom.py)
sed -n 's/^Source: //p; s/^Version: //p' ./*.dsc | paste -d ' ' - - >"$folder/versions"

# with_cmake NAME OPTION...: builds and installs a source that has a CMakeLists.txt.
with_cmake() {
  local name=$1
  shift
  echo "building $name" >&3
  cmake -S "$name" -B "build-$name" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=OFF \
    -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DCMAKE_INSTALL_PREFIX="$folder" -DCMAKE_INSTALL_LIBDIR=lib \
    -DCMAKE_PREFIX_PATH="$folder" "$@"
  cmake --build "build-$name" --parallel "$jobs" --target install
}
echo "building zlib" >&3  # not with CMake: its CMakeLists.txt lists sources that Debian leaves out
(cd zlib && CFLAGS="-O2 -fPIC" ./configure --static --prefix="$folder" && make -j "$jobs" install)
with_cmake libpng1.6 -DPNG_SHARED=OFF -DPNG_TESTS=OFF -DZLIB_ROOT="$folder"
with_cmake yaml-cpp -DYAML_CPP_BUILD_TESTS=OFF -DYAML_CPP_BUILD_TOOLS=OFF -DYAML_BUILD_SHARED_LIBS=OFF
with_cmake fmtlib -DFMT_TEST=OFF -DFMT_DOC=OFF
with_cmake tinyxml2 -Dtinyxml2_BUILD_TESTING=OFF -DBUILD_TESTING=OFF
echo "building hdf5" >&3  # with configure: its CMake files list files that Debian leaves out
mkdir -p build-hdf5
(cd build-hdf5 && bash ../hdf5/configure --prefix="$folder" --disable-shared --enable-static --with-pic --disable-hl \
  --disable-fortran --disable-cxx --without-szlib --with-zlib="$folder" --enable-threadsafe --disable-tests --disable-tools \
  --enable-build-mode=production && make -j "$jobs" -C src && make -C src install)

# NLopt's algorithms in its folder luksan have the license LGPL. taut uses none of them; stubs that
# report a failure replace them.
python3 - <<'END'
import pathlib, re
cmake = pathlib.Path("nlopt/CMakeLists.txt")
text = cmake.read_text()
cmake.write_text(re.sub(r"\n[^\n]*src/algs/luksan/[^\n]*\.c[^\n]*", "\n  ", text))
END
rm -rf nlopt/src/algs/luksan/*.c
with_cmake nlopt -DNLOPT_CXX=OFF -DNLOPT_PYTHON=OFF -DNLOPT_OCTAVE=OFF -DNLOPT_MATLAB=OFF -DNLOPT_GUILE=OFF \
  -DNLOPT_SWIG=OFF -DNLOPT_TESTS=OFF
cat >stubs.c <<'END'
/* Stubs of the omitted algorithms (see static_libraries.sh). NLopt's error code -1 is a failure. */
int luksan_plis(void) { return -1; }
int luksan_plip(void) { return -1; }
int luksan_pnet(void) { return -1; }
END
gcc -O2 -fPIC -c stubs.c
ar r "$folder/lib/libnlopt.a" stubs.o

echo "building sqlite3" >&3
mkdir -p build-sqlite3
(cd build-sqlite3 && ../sqlite3/configure --disable-shared --disable-tcl --disable-readline --disable-load-extension &&
  make sqlite3.c sqlite3.h)
gcc -O2 -fPIC -DSQLITE_OMIT_LOAD_EXTENSION -DSQLITE_THREADSAFE=1 -c build-sqlite3/sqlite3.c -o sqlite3.o
ar rcs "$folder/lib/libsqlite3.a" sqlite3.o
cp build-sqlite3/sqlite3.h "$folder/include/"

echo "building qr-code-generator" >&3
g++ -O2 -fPIC -c qr-code-generator/cpp/qrcodegen.cpp -o qrcodegen.o
ar rcs "$folder/lib/libqrcodegencpp.a" qrcodegen.o
cp qr-code-generator/cpp/qrcodegen.hpp "$folder/include/"

cd "$folder"
rm -rf src bin
echo "$recipe" >made
echo "libraries: $(ls lib/*.a | wc -l) in $folder/lib" >&3
