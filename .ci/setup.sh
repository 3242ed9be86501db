#!/usr/bin/env bash
# Finds out what Mouthpiece lacks on this machine and installs just that.
#
#   .ci/setup.sh          what building and running need: anything missing ends it with status 1
#   .ci/setup.sh --test   also what the live test needs; without it that test is skipped
#
# Looks for the things themselves (a compiler, a library file), not for packages, so that whatever is
# there already, from wherever, counts. Installs on Debian and Ubuntu only; elsewhere it prints the
# names of the packages. Says what and why before it asks for root.
set -euo pipefail

with_tests=false
[ "${1:-}" = "--test" ] && with_tests=true

rust_needed=1.92

packages=() # Debian's names, in order
missing() { # missing PACKAGE WHY
    echo "  $1: $2"
    packages+=("$1")
}

has() { command -v "$1" >/dev/null 2>&1; }

has_library() { # has_library SONAME: on the loader's list
    local loader=ldconfig
    has ldconfig || loader=/sbin/ldconfig
    # Not grep -q: it would close the pipe early, which pipefail takes for a failure.
    "$loader" -p 2>/dev/null | grep -F "$1" >/dev/null
}

has_vulkan_driver() {
    [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] && return 0
    local folder
    for folder in /usr/share /usr/local/share /etc "${XDG_DATA_HOME:-$HOME/.local/share}"; do
        compgen -G "$folder/vulkan/icd.d/*.json" >/dev/null && return 0
    done
    return 1
}

has_alsa_pulse() {
    local folder
    for folder in "/usr/lib/*" /usr/lib /usr/lib64; do
        compgen -G "$folder/alsa-lib/libasound_module_pcm_pulse.so" >/dev/null && return 0
    done
    return 1
}

need_rust() {
    local how="install Rust $rust_needed or newer (https://rustup.rs):
    curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y && . \"\$HOME/.cargo/env\""
    if ! has cargo; then
        echo "setup: cargo is not installed; $how" >&2
        exit 1
    fi
    local version
    version=$(cargo --version | cut -d' ' -f2)
    if [ "$(printf '%s\n' "$rust_needed" "${version%%-*}" | sort -V | head -n1)" != "$rust_needed" ]; then
        echo "setup: cargo $version is too old; $how" >&2
        exit 1
    fi
}

look_for_build() {
    if ! { has cc && has c++; }; then
        missing build-essential "compiler and linker; the H.264 encoder is C++"
    fi
    has pkg-config || missing pkg-config "finds the sound library"
    if ! { has pkg-config && pkg-config --exists alsa; }; then
        missing libasound2-dev "headers of ALSA, the way to the sound device"
    fi
}

look_for_run() {
    has_library libvulkan.so.1 || missing libvulkan1 "Vulkan, which draws the head"
    has_vulkan_driver || missing mesa-vulkan-drivers "no Vulkan driver here; this one can draw on the processor"
    local pair
    for pair in libxkbcommon-x11.so.0:libxkbcommon-x11-0 libX11-xcb.so.1:libx11-xcb1 \
        libXcursor.so.1:libxcursor1 libXi.so.6:libxi6 libXrandr.so.2:libxrandr2; do
        has_library "${pair%%:*}" || missing "${pair##*:}" "a window under X11"
    done
}

look_for_test() {
    has Xvfb || missing xvfb "a screen of its own for the live test"
    has pulseaudio || missing pulseaudio "a sound device of its own for the live test"
    has parec || missing pulseaudio-utils "records what the live test hears"
    has_alsa_pulse || missing libasound2-plugins "leads ALSA's sound to PulseAudio"
    has ffmpeg || missing ffmpeg "a second opinion on the videos that are written"
    has python3 || missing python3 "runs the live test"
    has socat || missing socat "runs the example client in shell"
    has flite || missing flite "a voice, so that speaking a text is tested"
    has espeak-ng || missing espeak-ng "another voice"
    has cage || missing cage "the compositor of the Wayland recipe"
    has Xwayland || missing xwayland "which cage does not start without"
    has grim || missing grim "takes a picture of what cage shows"
}

as_root() {
    if [ "$(id -u)" = 0 ]; then
        "$@"
    elif has sudo; then
        sudo "$@"
    else
        echo "setup: this needs root and there is no sudo; run as root: $*" >&2
        return 1
    fi
}

install_packages() {
    if [ "$(id -u)" != 0 ]; then
        echo "setup: installing them needs root: sudo apt-get install ${packages[*]}"
    fi
    as_root apt-get update -q </dev/null &&
        as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends \
            "${packages[@]}" </dev/null
}

print_packages() {
    cat >&2 <<'LIST'
setup: packages are installed for you on Debian and Ubuntu only; elsewhere:
  Fedora  sudo dnf install gcc gcc-c++ make pkgconf-pkg-config alsa-lib-devel vulkan-loader mesa-vulkan-drivers libxkbcommon-x11 libX11-xcb libXcursor libXi libXrandr
          for the live test: xorg-x11-server-Xvfb pulseaudio pulseaudio-utils alsa-plugins-pulseaudio ffmpeg-free python3 flite espeak-ng
  Arch    sudo pacman -S --needed base-devel alsa-lib vulkan-icd-loader vulkan-swrast libxkbcommon-x11 libx11 libxcursor libxi libxrandr
          for the live test: xorg-server-xvfb pulseaudio alsa-plugins ffmpeg python espeak-ng
          (vulkan-swrast draws on the processor; a graphics card has its own: vulkan-radeon, vulkan-intel, nvidia-utils)
LIST
}

# What is missing in one group, then the way to get it. Status 1 when it is still missing.
provide() { # provide LOOK
    packages=()
    local found
    found=$(mktemp)
    "$1" >"$found"
    if [ ${#packages[@]} = 0 ]; then
        rm -f "$found"
        return 0
    fi
    echo "setup: this machine lacks"
    cat "$found"
    rm -f "$found"
    if ! has apt-get; then
        print_packages
        return 1
    fi
    install_packages
}

look_for_all() {
    look_for_build
    look_for_run
}

need_rust
case "$(uname -s)" in
Darwin)
    if ! xcode-select -p >/dev/null 2>&1; then
        echo "setup: the compiler is missing; install Apple's command line tools: xcode-select --install" >&2
        exit 1
    fi
    ;;
Linux)
    provide look_for_all || {
        echo "setup: what is listed above is needed; install it and try again" >&2
        exit 1
    }
    if $with_tests; then
        provide look_for_test ||
            echo "setup: going on without; what needs them is skipped and says so" >&2
    fi
    ;;
*)
    echo "setup: nothing is known about $(uname -s); going on" >&2
    ;;
esac

# A browser for the page of health, where the system has one to install.
if $with_tests && has apt-get && ! { has chromium-headless-shell || has chromium || has google-chrome; }; then
    echo "setup: installing chromium-headless-shell: the page of health is tested in it"
    { as_root apt-get update -q && as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -q --no-install-recommends chromium-headless-shell; } </dev/null >/dev/null 2>&1 ||
        echo "setup: it cannot be installed; the test that needs it is skipped and says so" >&2
fi

# Khronos's judge of head files, where npm is at hand.
validator=target/node/node_modules/gltf-validator
if $with_tests && has npm && [ ! -d "$validator" ]; then
    npm install --silent --no-audit --no-fund --prefix target/node gltf-validator@2.0.0-dev.3.10 </dev/null >/dev/null 2>&1 ||
        echo "setup: gltf-validator cannot be installed; the test that asks it is skipped and says so" >&2
fi
