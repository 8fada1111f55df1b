#!/bin/sh
# Make libngspice available: use what the system has, else install Debian's package, else unpack it beside the
# virtual environment (no root needed). Says plainly what it cannot do.
set -eu
venv=${1:?usage: install_ngspice.sh VIRTUAL_ENVIRONMENT}
folder=$venv/lib/ngspice

found() {
    [ -n "${NGSPICE_LIBRARY_PATH:-}" ] && [ -e "$NGSPICE_LIBRARY_PATH" ] && return 0
    ls "$folder"/libngspice.so* >/dev/null 2>&1 && return 0
    "$venv/bin/python" -c 'import ctypes.util, sys; sys.exit(ctypes.util.find_library("ngspice") is None)'
}

by_hand() {
    echo "libngspice is missing and could not be installed here ($1)." >&2
    echo "Install it: Debian, Ubuntu: apt-get install libngspice0; Fedora: dnf install libngspice;" >&2
    echo "conda-forge: ngspice-lib; Homebrew: libngspice. Or set NGSPICE_LIBRARY_PATH to the library's file." >&2
    exit 1
}

found && exit 0
command -v apt-get >/dev/null || by_hand "there is no apt-get"

if [ "$(id -u)" = 0 ]; then root=; elif sudo -n true 2>/dev/null; then root="sudo -n"; else root=none; fi
if [ "$root" != none ]; then
    echo "installing libngspice0"
    $root apt-get install -y -qq --no-install-recommends libngspice0 >/dev/null 2>&1 ||
        { $root apt-get update -qq && $root apt-get install -y -qq --no-install-recommends libngspice0 >/dev/null; } ||
        by_hand "apt-get install libngspice0 failed"
    found && exit 0
    by_hand "it is installed, but the loader does not find it"
fi

echo "no root: unpacking libngspice0 to $folder"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fetch() { (cd "$work" && apt-get download -qq "$@" >/dev/null 2>&1) || return 1; }
fetch libngspice0 || by_hand "apt-get download libngspice0 failed"
dpkg -x "$work"/libngspice0*.deb "$work/root"
mkdir -p "$folder"
find "$work/root" \( -type f -o -type l \) -name '*.so*' -exec cp -P {} "$folder" \;
for needed in "libgomp.so.1 libgomp1" "libfftw3.so.3 libfftw3-double3"; do
    library=${needed% *}
    if ldd "$folder"/libngspice.so.0 | grep -q "$library => not found"; then
        fetch "${needed#* }" || by_hand "it needs $library, and apt-get download ${needed#* } failed"
        dpkg -x "$work/${needed#* }"*.deb "$work/more"
        find "$work/more" -name "$library*" -exec cp -P {} "$folder" \;
    fi
done
found || by_hand "the package holds no libngspice.so"
