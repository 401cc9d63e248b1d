#!/bin/sh
# Installs the Debian packages that a step needs and that are missing, and says so.
#   scripts/install-deps.sh [build] [test] [demo] [bench] [format] [fuzz]
# Without root or sudo it says what to install and fails. docs/DEPENDENCIES.md says why each
# package is there.
set -eu

build="cmake ninja-build gcc g++ pkg-config libassimp-dev libmeshoptimizer-dev libcglm-dev
       libepoxy-dev libglfw3-dev libegl-dev libegl-mesa0 libgl1-mesa-dri libopenimageio-dev
       libimath-dev libsqlite3-dev libzstd-dev libxxhash-dev libjansson-dev libcmocka-dev"
test="xvfb xdotool"
demo="jq"
bench="jq imagemagick"
format="clang-format clang-tidy"
fuzz="clang libclang-rt-dev"

wanted=""
for group in "${@:-build}"; do
    case $group in
    build) wanted="$wanted $build" ;;
    test) wanted="$wanted $test" ;;
    demo) wanted="$wanted $demo" ;;
    bench) wanted="$wanted $bench" ;;
    format) wanted="$wanted $format" ;;
    fuzz) wanted="$wanted $fuzz" ;;
    *) echo "install-deps: there is no group \`$group\`" >&2; exit 1 ;;
    esac
done

if ! command -v dpkg-query > /dev/null; then
    echo "install-deps: this is no Debian; see docs/DEPENDENCIES.md for what is needed" >&2
    exit 0
fi

missing=""
for package in $wanted; do
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null || true)
    [ "$state" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

echo "missing Debian packages:$missing"
if [ "$(id -u)" = 0 ]; then
    as_root=""
elif command -v sudo > /dev/null; then
    as_root=sudo
else
    echo "install-deps: no root and no sudo; please run: apt-get install$missing" >&2
    exit 1
fi
echo "installing them with apt-get"
# The package lists may be absent or old: fetch them when the first try fails.
install="env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends"
# shellcheck disable=SC2086 # lists of words
$as_root $install $missing > /dev/null 2>&1 || {
    $as_root apt-get update
    $as_root $install $missing
}
