#!/bin/sh
# Unpacks llvmpipe of other Debian suites into a folder and installs nothing: Mesa with all that it needs, down to
# the C library. DIR/llvmpipe is then the harness that $LLVMPIPE_BENCH names, run by that Mesa.
#
#   mesa.sh DIR SUITE…     the last suite is preferred: `bookworm bookworm-backports`, `sid`
set -eu
[ $# -ge 2 ] || { sed -n '2,5s/^# \{0,1\}//p' "$0" >&2; exit 2; }
: "${LLVMPIPE_BENCH:?has to name the harness}"
harness=$(realpath "$LLVMPIPE_BENCH")
mkdir -p "$1"
cd "$1"
dir=$(pwd)
shift

# apt with lists of its own: what is installed and what the system's lists say stays as it is.
mkdir -p apt/parts apt/lists/partial apt/cache/archives/partial debs
: > apt/status
debian=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' | head -n 1)
for suite; do
  echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $debian $suite main"
done > apt/sources.list
cat > apt/conf <<END
Dir::Etc::sourcelist "$dir/apt/sources.list";
Dir::Etc::sourceparts "$dir/apt/parts";
Dir::State "$dir/apt";
Dir::State::status "$dir/apt/status";
Dir::Cache "$dir/apt/cache";
APT::Default-Release "$suite";
APT::Sandbox::User "root";
END
export APT_CONFIG="$dir/apt/conf"
apt-get -q update
packages=$(apt-cache depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks \
  --no-replaces --no-enhances libegl-mesa0 libegl1 libopengl0 zlib1g | grep '^[a-z]' | sort -u)
(cd debs && apt-get -q download $packages)
for deb in debs/*.deb; do
  dpkg -x "$deb" .
done

# The loader comes from the same suite as the C library.
lib=$dir/usr/lib/x86_64-linux-gnu
loader=$(ls "$lib"/ld-linux-x86-64.so.2 "$dir"/lib/x86_64-linux-gnu/ld-linux-x86-64.so.2 2>/dev/null | head -n 1)
cat > llvmpipe <<END
#!/bin/sh
export LIBGL_DRIVERS_PATH="$lib/dri" __EGL_VENDOR_LIBRARY_FILENAMES="$dir/usr/share/glvnd/egl_vendor.d/50_mesa.json"
exec "$loader" --library-path "$lib:$dir/lib/x86_64-linux-gnu" "$harness" "\$@"
END
chmod +x llvmpipe
LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe ./llvmpipe fill flat --layers 1 --frames 1 2>&1 >/dev/null
