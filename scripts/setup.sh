# Sourced by the other scripts: goes to the project's folder and installs the Debian packages that are missing.
cd "$(dirname "${BASH_SOURCE[0]}")/.."

install_packages() { # further lists may be named
    local wanted missing=() package
    wanted=$(grep -hv '^#' scripts/packages.txt "$@")
    for package in $wanted; do
        dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] && return
    echo "installing: ${missing[*]}"
    local sudo=
    [ "$(id -u)" -eq 0 ] || sudo=sudo
    $sudo apt-get update -qq
    DEBIAN_FRONTEND=noninteractive $sudo apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# A file that any clone here has compiled before is not compiled again; the instruction set that
# "native" stands for is a part of its key.
export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
export CCACHE_COMPILERCHECK='%compiler% -march=native -dM -E -x c++ /dev/null'

build() {
    install_packages
    cmake --preset "$1" >/dev/null
    cmake --build --preset "$1" --target "${@:2}"
}
