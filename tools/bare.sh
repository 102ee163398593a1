# Sourced by tools/test-bare and tools/packages: a Debian of its own, in a folder, which has nothing but its base system.
# Needs root, debootstrap and a Debian mirror.
#
#   find_bare SUITE [FOLDER]    sets $bare and makes it where there is none; a folder that nobody named goes at the end
#   in_bare COMMAND …           runs a command in it, as root, in an environment of its own

mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}

say_missing() {
  echo "SKIPPED: $1"
  exit 0
}

find_bare() {
  [ "$(id -u)" -eq 0 ] || say_missing "only root can make a system of its own"
  command -v debootstrap >/dev/null || say_missing "debootstrap is missing (apt install debootstrap)"
  unshare --mount true 2>/dev/null || say_missing "this machine lets nobody mount /proc elsewhere"
  local suite=$1
  if [ -n "${2:-}" ]; then
    bare=$2
  else
    bare=$(mktemp -d /var/tmp/nutik-bare-XXXXXX)
    trap 'rm -rf --one-file-system "$bare"' EXIT
  fi
  if [ ! -x "$bare/bin/bash" ]; then
    debootstrap --variant=minbase --include=ca-certificates,git "$suite" "$bare" "$mirror" ||
      say_missing "no Debian $suite could be fetched from $mirror; set DEBIAN_MIRROR"
  fi
  cp /etc/resolv.conf "$bare/etc/resolv.conf"
}

# The mounts end with the command.
in_bare() {
  # shellcheck disable=SC2016
  unshare --mount bash -euc '
    bare=$1
    shift
    mount -t proc proc "$bare/proc"
    mount -t sysfs -o ro sysfs "$bare/sys"                  # PoCL ends the program without it
    mount --rbind /sys/fs/cgroup "$bare/sys/fs/cgroup"      # no node of Slurm starts without them
    for each in null zero random urandom; do
      [ -c "$bare/dev/$each" ] || { touch "$bare/dev/$each"; mount --bind "/dev/$each" "$bare/dev/$each"; }
    done
    [ -d "$bare/dev/shm" ] || mkdir "$bare/dev/shm"
    mount -t tmpfs tmpfs "$bare/dev/shm"
    exec chroot "$bare" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
      DEBIAN_FRONTEND=noninteractive \
      ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} "$@"
  ' bash "$bare" "$@"
}
