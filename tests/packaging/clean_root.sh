#!/bin/bash
# clean_root.sh PACKAGES SOURCE PROGRAMS: installs the packages of a folder into a new Debian, runs the programs there on the sample rawlog, and
# builds another project against them. PROGRAMS is the folder of the same programs outside of it: results must be equal.
# Takes minutes and a few gigabytes: only with VIWO_TEST_CHROOT=1. Exit status 77: skipped.
set -euo pipefail
packages=$(realpath "$1") source=$(realpath "$2") programs=$(realpath "$3")

skip() {
	echo "skipped: $*"
	exit 77
}

[ "${VIWO_TEST_CHROOT:-}" = 1 ] || skip "VIWO_TEST_CHROOT=1 installs the packages into a clean root: minutes, a few gigabytes, and a mirror"
[ "$(id -u)" -eq 0 ] || skip "only root can make a clean root"
command -v debootstrap >/dev/null || skip "debootstrap is not here (package debootstrap)"
release=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
# shellcheck disable=SC2016 # apt-get replaces these
archives=$(apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' | sort -u)
mirror=$(awk -v release="$release" '$3 == release { print $2; exit }' <<<"$archives")
[ -n "$mirror" ] || skip "apt knows no mirror of Debian $release"

root=$(mktemp -d /var/tmp/viwo_root_XXXXXX)
clean() {
	umount "$root/proc" 2>/dev/null || true
	rm -rf --one-file-system "$root"
}
trap clean EXIT
# step NAME COMMAND...: one line; all of its output where it fails.
step() {
	local name=$1 log=$root.log start=$SECONDS
	shift
	"$@" >"$log" 2>&1 || {
		tail -n 40 "$log"
		echo "failed: $name"
		exit 1
	}
	echo "$name: $((SECONDS - start)) s"
	rm -f "$log"
}
inside() {
	chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
}
# For the network: what this machine knows of proxies and names.
apt_options=()
while read -r name value; do apt_options+=(-o "$name=$value"); done < <(apt-config dump | sed -nE 's/^(Acquire::https?::Proxy) "(.*)";$/\1 \2/p')
install() {
	inside ${http_proxy:+http_proxy="$http_proxy"} apt-get "${apt_options[@]}" install -q -y --no-install-recommends "$@"
}

step "a new Debian $release of $mirror" debootstrap --variant=minbase "$release" "$root" "$mirror"
echo "$archives" >"$root/etc/apt/sources.list"
mount -t proc proc "$root/proc" || skip "no /proc can be mounted in a clean root"
mkdir "$root/packages"
cp "$packages"/*.deb "$root/packages/"
step "its package lists" inside ${http_proxy:+http_proxy="$http_proxy"} apt-get "${apt_options[@]}" update -q

cd "$root"
before=$(inside sh -c "dpkg-query -W | wc -l")
step "install viwo" install ./packages/viwo_*.deb ./packages/libviwo0_*.deb
echo "packages that came with it: $(($(inside sh -c "dpkg-query -W | wc -l") - before))"
for page in "$source"/doc/man/*.1; do
	program=$(basename "$page" .1)
	step "$program --version" inside "$program" --version
done
for file in sample.rawlog sample_ground_truth.tum sample_Images; do cp -r "$source/rawlogs/$file" "$root/root/"; done
step "viwo-odometry on the sample" inside viwo-odometry -i /root/sample.rawlog -o /root/out
step "the same outside" "$programs/viwo-odometry" -i "$source/rawlogs/sample.rawlog" -o "$root/root/outside"
step "the same trajectory" cmp "$root/root/out/trajectory.tum" "$root/root/outside/trajectory.tum"
step "viwo-evaluate" inside viwo-evaluate -r /root/sample_ground_truth.tum -e /root/out/trajectory.tum --max-ate 0.05 --min-coverage 0.9
step "viwo-groundtruth" inside viwo-groundtruth -i /root/sample.rawlog -o /root/truth -c /usr/share/viwo/config_files/viwo-groundtruth/lms100.ini
step "viwo-sim, of shared files" inside viwo-sim --sequence seq05 --no-images -o /root/simulated.rawlog
step "completion" inside bash -c 'source /usr/share/bash-completion/completions/viwo-odometry && complete -p viwo-odometry'

step "install libviwo-dev" install ./packages/libviwo-dev_*.deb cmake make g++
cp -r "$source/tests/consumer" "$root/root/"
step "configure another project" inside cmake -S /root/consumer -B /root/consumer/build -DCMAKE_BUILD_TYPE=Release
step "build it" inside cmake --build /root/consumer/build
step "run it" inside /root/consumer/build/viwo_consumer

step "purge" inside apt-get purge -q -y viwo libviwo0 libviwo-dev
left=$(inside sh -c "find /usr /etc /var -name '*viwo*' ! -path '/var/log/*'")
[ -z "$left" ] || {
	echo "failed: left after purging: $left"
	exit 1
}
echo "nothing is left of it"
