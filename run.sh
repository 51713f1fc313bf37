#!/bin/bash
# The project's verbs: ./run.sh demo | test | build | accuracy | package | doc | prepare | format   (./run.sh without a word explains them)
set -euo pipefail
cd "$(dirname "$0")"

build_dir=${VIWO_BUILD_DIR:-build}
jobs=${VIWO_JOBS:-$(nproc)}
targets=() # empty: all
packages=(build-essential cmake ninja-build ccache libeigen3-dev libceres-dev libopencv-dev nlohmann-json3-dev libcli11-dev libyaml-cpp-dev libgtest-dev
	libmrpt-obs-dev libmrpt-poses-dev libmrpt-config-dev libmrpt-io-dev libmrpt-maps-dev libmrpt-system-dev mrpt-apps mrpt-common liboctomap-dev octomap-tools zlib1g-dev libbz2-dev
	file man-db doxygen
	librosbag-storage-dev libroscpp-core-dev libsensor-msgs-dev libnav-msgs-dev libtf2-msgs-dev)

usage() {
	cat <<'TEXT'
usage: ./run.sh VERB
  demo      build, run three modes on the sample rawlog, print a table of their errors, and make a map of its scans
  test      build and run all tests
  build     build the programs into build/bin
  accuracy  measure the accuracy table (long); writes build/accuracy/
  package   make Debian packages (viwo, libviwo0, libviwo-dev) in build/packages/
  doc       make the reference of the libraries (doxygen) in build/doc/html
  prepare   install what building needs, and nothing else
  format    clang-format on all sources
Each installs what is missing from Debian first. VIWO_JOBS sets the number of compile jobs, VIWO_BUILD_DIR the build folder.
TEXT
}

fail() {
	echo "run.sh: error: $*" >&2
	exit 1
}

install_missing() {
	local missing=() package
	for package in "$@"; do
		dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
	done
	[ ${#missing[@]} -eq 0 ] && return
	local as_root=()
	if [ "$(id -u)" -ne 0 ]; then
		command -v sudo >/dev/null || fail "these packages are missing: ${missing[*]}; install them as root (apt-get install ...)"
		as_root=(sudo)
	fi
	echo "Installing ${missing[*]}"
	"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
	"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# configure DIR [cmake options]
configure() {
	local dir=$1
	shift
	local generator=()
	if [ ! -e "$dir/CMakeCache.txt" ] && command -v ninja >/dev/null; then generator=(-G Ninja); fi
	local log
	log=$(cmake -S . -B "$dir" "${generator[@]}" "$@" 2>&1) || {
		echo "$log" >&2
		fail "cmake could not configure $dir"
	}
}

# build [cmake options]
build() {
	install_missing "${packages[@]}"
	configure "$build_dir" -DCMAKE_BUILD_TYPE=Release "$@"
	cmake --build "$build_dir" -j "$jobs" ${targets[@]+--target "${targets[@]}"}
}

demo() {
	targets=(viwo-odometry viwo-evaluate viwo-groundtruth)
	build
	local bin=$build_dir/bin out=$build_dir/demo mode estimates=()
	for mode in wheel vio viwo; do
		echo
		echo "== viwo-odometry --mode $mode"
		rm -rf "${out:?}/$mode"
		mkdir -p "$out/$mode"
		# A mode that finds no start on this motion is a row without figures in the table.
		"$bin/viwo-odometry" -i rawlogs/sample.rawlog -o "$out/$mode" --mode "$mode" || echo "no trajectory in mode $mode"
		estimates+=(-e "$out/$mode/trajectory.tum")
	done
	echo
	echo "Errors against rawlogs/sample_ground_truth.tum, after alignment by rotation and translation:"
	"$bin/viwo-evaluate" -r rawlogs/sample_ground_truth.tum "${estimates[@]}" --allow-missing --json "$out/errors.json" --svg "$out/trajectories.svg"
	echo
	echo "== viwo-groundtruth: trajectory and map from LiDAR scans and odometry"
	"$bin/viwo-groundtruth" -i rawlogs/sample.rawlog -o "$out/groundtruth" -c share/viwo/config_files/viwo-groundtruth/lms100.ini
	"$bin/viwo-evaluate" -r rawlogs/sample_ground_truth.tum -e "$out/groundtruth/trajectory.tum"
	echo "The map: $out/groundtruth/map.png"
	echo
	echo "Written:"
	find "$out" -type f | LC_ALL=C sort | sed 's/^/  /'
}

run_tests() {
	build
	(cd "$build_dir" && ctest --output-on-failure -j2 "$@")
}

accuracy() {
	build
	[ -x "$build_dir/bin/viwo_accuracy" ] || fail "$build_dir/bin/viwo_accuracy was not built"
	"$build_dir/bin/viwo_accuracy" "$@"
}

package() {
	install_missing "${packages[@]}"
	# Debian's flags, but for debug information, which would be stripped; and programs that know no path of this folder.
	export DEB_BUILD_MAINT_OPTIONS=hardening=+bindnow
	local flags
	flags=$(dpkg-buildflags --get CXXFLAGS)
	CXXFLAGS="$(dpkg-buildflags --get CPPFLAGS) ${flags#-g }" LDFLAGS=$(dpkg-buildflags --get LDFLAGS) configure "$build_dir/package" \
		-DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DVIWO_PACKAGE=ON -DVIWO_BUILD_TESTS=OFF "$@"
	cmake --build "$build_dir/package" -j "$jobs"
	rm -rf "$build_dir/packages"
	local out
	out=$(realpath "$build_dir")/packages
	(cd "$build_dir/package" && cpack -B "$out" >/dev/null)
	rm -rf "$out/_CPack_Packages"
	if command -v lintian >/dev/null; then lintian --allow-root --fail-on error "$out"/*.deb; fi
	ls "$out"/*.deb
}

reference() {
	install_missing "${packages[@]}"
	configure "$build_dir" -DCMAKE_BUILD_TYPE=Release
	cmake --build "$build_dir" --target doc
	echo "$build_dir/doc/html/index.html"
}

format() {
	install_missing clang-format
	find apps libs tests \( -name '*.h' -o -name '*.cpp' \) -print0 | xargs -0 clang-format -i
}

verb=${1:-}
[ $# -gt 0 ] && shift
case $verb in
demo) demo ;;
test) run_tests "$@" ;;
build) build "$@" ;;
accuracy) accuracy "$@" ;;
package) package "$@" ;;
doc) reference ;;
prepare) install_missing "${packages[@]}" ;;
format) format ;;
-h | --help | help) usage ;;
*)
	usage >&2
	exit 2
	;;
esac
