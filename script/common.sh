# Sourced by the other scripts: goes to the top of the tree, sets up compiler cache and job count.
# shellcheck shell=bash
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
jobs=${TAUT_JOBS:-$(nproc)}

# configure PRESET: makes build/PRESET ready; quiet unless it fails.
configure() {
  local log=build/$1.configure.log
  mkdir -p build
  if ! cmake --preset "$1" >"$log" 2>&1; then
    cat "$log" >&2
    echo "cmake --preset $1 failed" >&2
    return 1
  fi
}

# build PRESET [TARGET...]: builds build/PRESET.
build() {
  local preset=$1
  shift
  configure "$preset" || return 1
  cmake --build "build/$preset" --parallel "$jobs" ${1:+--target "$@"}
}

# build_quietly PRESET [TARGET...]: the same; shows what the compiler said only if it fails.
build_quietly() {
  local log=build/$1.build.log
  mkdir -p build
  if ! build "$@" >"$log" 2>&1; then
    grep -vE '^\[[0-9]+/[0-9]+\] [^:]*$' "$log" >&2
    return 1
  fi
}
