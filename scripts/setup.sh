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

build() {
    install_packages
    cmake --preset "$1" >/dev/null
    cmake --build --preset "$1" --target "${@:2}"
}
