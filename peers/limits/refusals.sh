#!/usr/bin/env bash
# What the system refuses: the size of files, threads, room on the disk, and time by signals. Each must be an error with the file's name, and
# leave no half file.
#
#     refusals.sh DURER MODEL
#
# The full disk needs the right to mount a file system of its own; where it is missing, that part says so.
set -uo pipefail
durer=$(realpath "$1")
model=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
faults=0

# expect NAME CODE PART OUTPUT: the last command's code and message, and no file of that name or beside it.
expect() {
  local name=$1 wanted=$2 part=$3 output=$4 fault=""
  [ "$code" = "$wanted" ] || fault="code $code"
  [ -z "$part" ] || grep -q -- "$part" said || fault="$fault; not said: $part"
  [ -e "$output" ] && fault="$fault; $output is there"
  compgen -G "$(dirname "$output")/.durer-*" >/dev/null && fault="$fault; a temporary file is left"
  if [ -n "$fault" ]; then
    faults=$((faults + 1))
    echo "$name: FAULT: $fault"
    sed 's/^/    /' said
  else
    echo "$name: code $code $(head -1 said)"
  fi
}

(ulimit -f 8; exec "$durer" render "$model" --size 1500 -o big.png) >said 2>&1
code=$?
expect "ulimit -f" 1 "big.png" big.png

# Root is not bound by a number of processes, so as another user where there is one.
limited='ulimit -u 1; exec "$0" render "$1" --size 64 --threads 4 -o "$2"'
chmod 777 . && : >said && chmod 666 said
if [ "$(id -u)" = 0 ]; then
  setpriv --reuid=65534 --regid=65534 --clear-groups bash -c "$limited" "$durer" "$model" "$PWD/few.png" >said 2>&1
else
  bash -c "$limited" "$durer" "$model" "$PWD/few.png" >said 2>&1
fi
code=$?
if [ "$code" = 0 ] && [ -s few.png ] && grep -q thread said; then
  echo "ulimit -u: $(head -1 said)"
else
  faults=$((faults + 1))
  echo "ulimit -u: FAULT: code $code"
  sed 's/^/    /' said
fi

mkdir full
if mount -t tmpfs -o size=64k tmpfs full 2>/dev/null; then
  "$durer" render "$model" --size 1500 -o full/a.png >said 2>&1
  code=$?
  expect "full disk" 1 "full/a.png" full/a.png
  umount full
else
  echo "full disk: no right to mount one; not tried"
fi

for signal in INT:130 TERM:143; do
  # A job in the background ignores Ctrl-C, so it is made to take it again.
  env --default-signal=INT "$durer" render "$model" --size 200 --turntable 900 -o frames/ >said 2>&1 &
  process=$!
  sleep "${SECONDS_BEFORE_SIGNALS:-1}"
  kill "-${signal%:*}" "$process"
  wait "$process"
  code=$?
  mkdir -p frames
  # A PNG that is whole ends so.
  for frame in frames/*.png; do
    [ ! -e "$frame" ] || tail -c 12 "$frame" | grep -q IEND || mv "$frame" frames/half.png
  done
  expect "SIG${signal%:*} after $(find frames -name '*.png' | wc -l) frames" "${signal#*:}" "" frames/half.png
  rm -rf frames
done
exit "$((faults > 0))"
