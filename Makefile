# The front door. CMake does the work; the presets in CMakePresets.json say how.
#
#   make            build the program: build/release/app/promenade
#   make demo       build, make a city, walk it, leave pictures and a report in out/demo;
#                   where there is a display, open the viewer
#   make test       the tests, optimised and under the sanitizers
#   make test-all   the slow ones too
#   make fuzz       search for inputs that break a parser, FUZZ_SECONDS (60) for each
#   make bench      tables of builds and frame times in out/bench; see tests/bench/run.sh

JOBS ?= $(shell nproc)
FUZZ_SECONDS ?= 60

.PHONY: all build deps demo test test-all fuzz bench format tidy clean

all: build

deps:
	@scripts/install-deps.sh build

build: deps
	@scripts/build.sh release promenade

demo: build
	@scripts/install-deps.sh demo
	@scripts/demo.sh build/release/app/promenade out/demo

test: deps
	@scripts/install-deps.sh test
	@scripts/test.sh -LE slow

test-all: deps
	@scripts/install-deps.sh test
	@scripts/test.sh

fuzz: deps
	@tests/fuzz/run.sh $(FUZZ_SECONDS)

bench: build
	@scripts/install-deps.sh bench
	@tests/bench/run.sh build/release/app/promenade out/bench

format:
	@scripts/install-deps.sh format
	git ls-files '*.c' '*.h' '*.cpp' | xargs clang-format -i

tidy: build
	@scripts/build.sh release
	@scripts/install-deps.sh format
	git ls-files '*.c' | xargs -P $(JOBS) -n 4 clang-tidy --quiet -p build/release

clean:
	rm -rf build out
