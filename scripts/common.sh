# shellcheck shell=bash
# Sourced by the scripts: the project's folder, configuring and building a preset, and steps with a summary.

root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
cores=$(nproc)

# Messages and their order must not depend on the machine's language. These variables, set or not, are also part of what
# ccache looks objects up by.
export LC_ALL=C.UTF-8 LANG=C.UTF-8
unset LC_CTYPE LC_MESSAGES

# SystemC 2.3.4 does not tell the sanitizer that it leaves the stack of a thread process that ends. The search for leaks
# at the end of the program would take that stack, by then unmapped, for main's, and crash on it now and then.
export LSAN_OPTIONS=use_stacks=0${LSAN_OPTIONS:+:$LSAN_OPTIONS}

# ccache avoids repeated compilation, also across clones. It is used only if its cache is writable.
if command -v ccache >/dev/null && ccache_folder=$(ccache --get-config cache_dir) &&
    mkdir -p "$ccache_folder" 2>/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
    export CCACHE_DIR=$ccache_folder  # for tests that give a build another home
    # Clones have different paths: paths below the project are made relative, the build folder is ignored.
    export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$root} CCACHE_NOHASHDIR=1 CCACHE_MAXSIZE=${CCACHE_MAXSIZE:-5G}
fi

# configured PRESET [-DNAME=VALUE...]: whether its build folder is complete and has this path and these values.
configured() {
    local folder="$root/build/$1" setting name
    [[ -f "$folder/build.ninja" ]] || return 1
    # A build folder that was moved or copied with the project still refers to the old path.
    grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt" || return 1
    for setting in "${@:2}"; do
        name=${setting#-D}
        grep -qx "${name%%=*}:[A-Z]*=${name#*=}" "$folder/CMakeCache.txt" || return 1
    done
}

# configure PRESET [-DNAME=VALUE...]: warnings are errors if TESSERA_WERROR is ON in the environment.
configure() {
    set -- "$@" "-DTESSERA_WERROR=${TESSERA_WERROR:-OFF}"
    configured "$@" && return 0
    local fresh=()
    configured "$1" || fresh=(--fresh)
    (cd "$root" && cmake --preset "$1" "${fresh[@]}" "${@:2}")
}

# build PRESET [TARGET...]: everything, or the targets. Ninja reconfigures by itself if a CMake file changed. A build
# folder that is not writable is accepted if it is up to date.
build() {
    local folder="$root/build/$1" targets=()
    (($# > 1)) && targets=(--target "${@:2}")
    if [[ ! -w "$folder" ]]; then
        cmake --build "$folder" "${targets[@]}" -- -n | grep -qx 'ninja: no work to do.' && return 0
        echo "$folder is not up to date and cannot be written: make it writable, or build in another checkout" >&2
        return 2
    fi
    # Two simultaneous builds in one folder would overwrite each other's objects.
    (
        flock 9
        cmake --build "$folder" --parallel "$cores" "${targets[@]}"
    ) 9>"$folder/lock"
}

# ready PART TARGET...: installs what PART needs and builds the targets in release.
ready() {
    "$root/scripts/install" "$1" || return
    # scripts/test configures the same folder with the tests, which may remain.
    configured release || configure release -DBUILD_TESTING=OFF -DTESSERA_BENCHMARK=OFF || return
    build release "${@:2}"
}

# python_with MODULE...: the path of a Python that has them. Debian's packages need Debian's interpreter, which may not be
# the first in the path.
python_with() {
    local candidate
    for candidate in $(type -ap python3 | uniq); do
        "$candidate" -c 'import sys; from importlib.util import find_spec as find
exit(not all(map(find, sys.argv[1:])))' "$@" 2>/dev/null && echo "$candidate" && return
    done
    echo "$(basename "$0"): no python3 in PATH has the modules $*; scripts/install installs them" >&2
    return 2
}

# Prints a script's leading comment; its first line is a summary.
explain() {
    sed -E '1d; /^(set |"""$)/Q; s/^(# ?|""")//' "$1"
}

summary=()
failed_steps=()
# step NAME COMMAND...: runs a step; if it fails, later steps still run.
step() {
    local name=$1 begin=$SECONDS verdict=passed line
    shift
    printf '\n======== %s ========\n' "$name"
    "$@" || { verdict=FAILED && failed_steps+=("$name: $*"); }
    printf -v line '%-7s %5d s  %s' "$verdict" "$((SECONDS - begin))" "$name"
    summary+=("$line")
    printf -- '-------- %s\n' "$line"
}

print_summary() {
    printf '\n======== summary: %d min ========\n' "$((SECONDS / 60))"
    printf '%s\n' "${summary[@]}"
}
