#!/bin/sh
# Fetches a real Blender on Debian into a folder outside the repository and prints the path of a command that
# starts it like any other program. Usage: fetch_blender.sh [FOLDER]
#
# Debian stable has none that is new enough, so a small tree of Debian unstable is made with debootstrap, and the
# command runs Blender inside it. The machine's own folders are seen there at the same paths, by mounts that only
# that process has and that end with it: removing FOLDER never reaches through them.
set -eu

folder=${1:-${XDG_CACHE_HOME:-$HOME/.cache}/keymark}
suite=sid
tree=$folder/debian-$suite
packages="blender python3-numpy python3-scipy python3-opencv python3-cattr python3-requests
    python3-pytest python3-hypothesis
    xvfb xauth xdotool imagemagick libgl1-mesa-dri libegl1 libegl-mesa0 libgl1 libopengl0"

say() { echo "$*" >&2; }
fail() { say "$*"; exit 1; }

other_way="name your own Blender instead: make test-blender BLENDER=/path/to/blender"

make_tree() {
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' 'Label: Debian' | head -n 1)
    [ -n "$mirror" ] || { apt-get update -qq >&2; mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' | head -n 1); }
    [ -n "$mirror" ] || fail "No Debian mirror stands in this machine's apt sources; $other_way"
    command -v debootstrap >/dev/null || { apt-get update -qq >&2; apt-get install -y -qq --no-install-recommends debootstrap >&2; }
    part=$tree.part
    rm -rf --one-file-system "$part"
    mkdir -p "$part"
    say "Fetching Debian $suite from $mirror (about 3 GB, once) ..."
    debootstrap --variant=minbase "$suite" "$part" "$mirror" >"$folder/fetch.log" 2>&1 ||
        fail "debootstrap failed; $folder/fetch.log says why; $other_way"
    apt-config dump | grep -E '^Acquire::(http|https)::Proxy ' >"$part/etc/apt/apt.conf.d/90proxy" || true
    # A mirror that stands still is no danger here, and the only one that some networks have.
    echo 'Acquire::Check-Valid-Until "false";' >"$part/etc/apt/apt.conf.d/91mirror"
    printf '#!/bin/sh\nexit 101\n' >"$part/usr/sbin/policy-rc.d" # no daemon is started in the tree
    chmod +x "$part/usr/sbin/policy-rc.d"
    say "Installing Blender there ..."
    # shellcheck disable=SC2086 # a list of words
    inside "$part" env DEBIAN_FRONTEND=noninteractive sh -ec '
        apt-get update -qq
        apt-get install -y -qq --no-install-recommends "$@"
        apt-get clean' sh $packages >>"$folder/fetch.log" 2>&1 ||
        fail "apt-get failed inside the tree; $folder/fetch.log says why; $other_way"
    echo "$packages" >"$part/keymark-packages"
    rm -rf --one-file-system "$tree"
    mv "$part" "$tree"
}

inside() { # TREE COMMAND...: only /proc, /dev and /sys are shared
    unshare --mount --propagation private sh -ec '
        tree=$1; shift
        for shared in proc dev sys; do mount --rbind "/$shared" "$tree/$shared"; done
        exec chroot "$tree" env PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 "$@"' sh "$@"
}

write_command() { # NAME WORDS: a command that runs WORDS and its own arguments inside the tree
    cat >"$folder/bin/$1.part" <<COMMAND
#!/bin/sh
# Written by tools/fetch_blender.sh. Runs \`$2\` inside $tree.
exec unshare --mount --propagation private sh -ec '
    tree=\$1; shift
    for folder in /*; do
        case \$folder in
            /bin | /boot | /etc | /lib* | /media | /run | /sbin | /usr | /var) continue ;;
        esac
        [ -d "\$folder" ] && [ ! -L "\$folder" ] || continue
        mkdir -p "\$tree\$folder"
        mount --rbind "\$folder" "\$tree\$folder"
    done
    exec chroot "\$tree" env -u LD_LIBRARY_PATH -u LD_PRELOAD -u PYTHONHOME -u PYTHONPATH \\
        PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \\
        sh -ec "cd \"\\\$1\"; shift; exec \"\\\$@\"" sh "\$@"' sh "$tree" "\$PWD" $2 "\$@"
COMMAND
    chmod +x "$folder/bin/$1.part"
    mv "$folder/bin/$1.part" "$folder/bin/$1"
}

[ -r /etc/debian_version ] || fail "A Blender is fetched only on Debian; $other_way"
[ "$(id -u)" = 0 ] || fail "A Blender is fetched only for root; $other_way"
unshare --mount --propagation private true 2>/dev/null || fail "This machine allows no mounts; $other_way"
mkdir -p "$folder/bin"
exec 9>"$folder/lock"
flock 9 # two calls at once make one tree
if [ "$(cat "$tree/keymark-packages" 2>/dev/null)" != "$packages" ]; then
    make_tree
fi
write_command blender "blender"
write_command blender-screen "xvfb-run -a -s '-screen 0 1920x1080x24 +extension GLX' blender"
version=$("$folder/bin/blender" --version </dev/null | head -n 1)
[ -n "$version" ] || fail "The fetched Blender does not start: remove $tree and try again, or $other_way"
say "$version is ready: $folder/bin/blender"
echo "$folder/bin/blender"
