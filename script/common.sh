# Common part of the other scripts, which source it: changes to the top of the tree, sets up the compiler
# cache and the number of jobs.
# shellcheck shell=bash
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
jobs=${TAUT_JOBS:-$(nproc)}

# configure PRESET: configures build/PRESET; quiet unless it fails.
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

# compiler_messages PRESET: prints the log of a failed build without its steps.
compiler_messages() { grep -vE '^\[[0-9]+/[0-9]+\] [^:]*$' "build/$1.build.log" >&2; }

# build_quietly PRESET [TARGET...]: same as build, but prints the compiler's messages only on failure.
build_quietly() {
  mkdir -p build
  build "$@" >"build/$1.build.log" 2>&1 || { compiler_messages "$1"; return 1; }
}

# build_showing PRESET [TARGET...]: same as build_quietly, with a progress line: rewritten on a terminal, once
# a minute elsewhere. Prints nothing if there is nothing to build.
build_showing() {
  local log=build/$1.build.log line done_count count started_s=$SECONDS shown_s=$SECONDS ended='' left
  mkdir -p build
  : >"$log"
  while IFS= read -r line; do
    echo "$line" >>"$log"
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
      done_count=${BASH_REMATCH[1]} count=${BASH_REMATCH[2]}
      if [ "$done_count" -eq 1 ]; then echo "Building: $count steps, on $jobs processors."; fi
      left=''
      if [ $((SECONDS - started_s)) -gt 20 ]; then
        left=$(((SECONDS - started_s) * (count - done_count) / done_count / 60 + 1))
        left=", about $left min left"
      fi
      if [ -t 1 ]; then
        printf '\r  %d of %d%s   ' "$done_count" "$count" "$left"
        ended=$'\n'
      elif [ $((SECONDS - shown_s)) -ge 60 ]; then
        printf '  %d of %d%s\n' "$done_count" "$count" "$left"
        shown_s=$SECONDS
      fi
    fi
  done < <(build "$@" 2>&1 || echo "the build failed")
  printf '%s' "$ended"
  [ "$(tail -n 1 "$log")" != "the build failed" ] || { compiler_messages "$1"; return 1; }
}

# apt_apart FOLDER KIND SUITE ARGUMENT...: runs apt-get with one archive only, as if no package were installed. SUITE: of
# Debian, or ubuntu/SUITE, verified with $ubuntu_keyring. KIND: deb or deb-src. FOLDER keeps apt's lists. Needed because
# the machine's sources may lack SUITE.
apt_apart() {
  local folder=$1 kind=$2 suite=$3 archive=http://deb.debian.org/debian
  local keyring=/usr/share/keyrings/debian-archive-keyring.gpg
  shift 3
  if [[ $suite == ubuntu/* ]]; then
    suite=${suite#ubuntu/} archive=http://archive.ubuntu.com/ubuntu keyring=$ubuntu_keyring
  fi
  mkdir -p "$folder/lists/partial" "$folder/archives/partial"
  echo "$kind [signed-by=$keyring] $archive $suite main" >"$folder/sources.list"
  apt-get -q -o "Dir::Etc::SourceList=$folder/sources.list" -o Dir::Etc::SourceParts=- \
    -o "Dir::State::Lists=$folder/lists" -o Dir::State::status=/dev/null -o Dir::Cache::pkgcache= \
    -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User= "$@"
}

# passed_commit: prints the last commit that passed CI (.ci/passed; TAUT_CI_PASSED overrides it); status 1
# if it is not in this clone.
passed_commit() {
  local passed=${TAUT_CI_PASSED:-$(cat .ci/passed)}
  git cat-file -e "$passed^{commit}" 2>/dev/null && echo "$passed"
}

# changed_files: prints the files that changed since CI last passed, and new ones; status 1 if that is unknown.
changed_files() {
  local passed
  passed=$(passed_commit) || return 1
  git diff --name-only "$passed" && git ls-files --others --exclude-standard
}
