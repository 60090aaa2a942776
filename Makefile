# microslip: build, install, test. `make help` lists the targets.

PREFIX ?= /usr/local
DESTDIR ?=
CARGO ?= cargo
INSTALL ?= install
# Not from the environment, where these names have other uses.
SHARED =
TARGET =
CPU =

version := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml)
sources := $(shell find src -type f) Cargo.toml Cargo.lock
# What is built for another processor with Linux is beside what is built for this one.
tree := $(if $(TARGET),target/$(TARGET)/)dist
ifneq ($(TARGET),)
cross := $(subst -unknown,,$(TARGET))-
export AR := $(cross)ar
export CC := $(cross)gcc
export LD := $(cross)ld
export NM := $(cross)nm
export OBJCOPY := $(cross)objcopy
endif
shared := lib/libmicroslip.so.$(shell sed -n 's/^\#define MSLIP_ABI_VERSION //p' include/microslip.h)
pcdir := lib/pkgconfig
cmakedir := lib/cmake/microslip
docdir := share/doc/microslip
files := lib/libmicroslip.a include/microslip.h include/microslip.f90 $(pcdir)/microslip.pc \
	$(cmakedir)/microslip-config.cmake $(cmakedir)/microslip-config-version.cmake \
	$(addprefix $(docdir)/,LICENSE-MIT LICENSE-APACHE THIRD-PARTY.md)
products := $(addprefix $(tree)/,$(files))

.PHONY: all shared install uninstall demo audit coverage miri test verify bench \
	figures identification host fuzz check parallel header python docs dist recipes release clean help always
.DELETE_ON_ERROR:

## all: build dist/, the tree that `install` copies (the default); CPU=x86-64 for processors without AVX2 (before 2013),
##   TARGET=aarch64-unknown-linux-gnu for another one
all: $(products)

# The sources are named here so that `make install`, as another user, need not run cargo again.
$(tree)/lib/libmicroslip.a: $(sources) tools/archive.sh tools/archive.toml tools/localise.sh $(if $(CPU),always)
	CPU="$(CPU)" CARGO="$(CARGO)" tools/archive.sh $@ target $(TARGET)

## shared: build the shared library besides
shared: $(tree)/$(shared)

$(tree)/$(shared): $(tree)/lib/libmicroslip.a include/microslip.h tools/shared.sh
	tools/shared.sh $< $@

# Templates have the version of this one.
copy = @mkdir -p $(@D) && sed 's/@VERSION@/$(version)/' $< > $@

$(tree)/include/%: include/%
	$(copy)

$(tree)/$(docdir)/%: %
	$(copy)

$(tree)/$(docdir)/%: packaging/%
	$(copy)

$(tree)/$(cmakedir)/%: packaging/%
	$(copy)

$(tree)/$(cmakedir)/%: packaging/%.in Cargo.toml
	$(copy)

$(tree)/$(pcdir)/%: packaging/%.in Cargo.toml
	$(copy)

## install: copy dist/ to $(DESTDIR)$(PREFIX); SHARED=1 with the shared library
install: all $(if $(SHARED),shared)
	@for file in $(files) $(if $(SHARED),$(shared)); do \
		$(INSTALL) -D -m 644 "$(tree)/$$file" "$(DESTDIR)$(PREFIX)/$$file" || exit 1; \
	done
	@$(if $(SHARED),ln -sf $(notdir $(shared)) "$(DESTDIR)$(PREFIX)/lib/libmicroslip.so")
	@echo "microslip $(version) is in $(DESTDIR)$(PREFIX)"

## uninstall: remove what `install` copied
uninstall:
	@for file in $(files) $(shared) lib/libmicroslip.so; do rm -f "$(DESTDIR)$(PREFIX)/$$file"; done
	@rmdir "$(DESTDIR)$(PREFIX)/$(cmakedir)" "$(DESTDIR)$(PREFIX)/$(docdir)" 2>/dev/null || true

## demo: run the Fortran examples and draw their figures (as root on Debian, installs missing packages)
demo:
	@tools/dependencies.sh --install demo
	$(MAKE) all
	$(MAKE) -C fortran_examples demo PREFIX=../dist

## parallel: check that OpenMP threads give the same bits for any number of them
parallel: all
	@tools/dependencies.sh parallel
	$(MAKE) -C fortran_examples parallel PREFIX=../dist

## test: the regular tests, in Rust, C and Fortran: some minutes (as root on Debian, installs missing packages)
test:
	tools/test.sh

## check: all other tests: lints, sanitizers, embedding, fuzzing, Miri, coverage, packages, audit; random tests with a new seed
check:
	tools/check.sh

## coverage: lines of src/ that the tests run; 98 % at least
coverage:
	tools/coverage.sh

## miri: the C interface under Miri, which finds undefined behaviour
miri:
	tools/miri.sh

## audit: licences, duplicates, sources and advisories of the dependencies
audit:
	tools/audit.sh

## verify: every output against multi-precision, and histories: an hour of processor time; POINTS=1e6 for less than the 1e7 of each
verify:
	@tools/dependencies.sh verify
	$(CARGO) run --locked --package verify -- \
		--points $(or $(POINTS),1e7) --replay verification/accuracy.csv --regions verification/accuracy.csv --promises docs/promises.csv

## bench: run time against error of the library and of what one would use instead; QUICK=1 for fewer cases
bench: all
	@tools/dependencies.sh bench
	$(MAKE) -C verification/benches run PREFIX=../../dist QUICK=$(QUICK)

## figures: compute the figures of the paper and of the validation into docs/, draw them, and check the claims
figures: all
	@tools/dependencies.sh figures
	$(CARGO) run --quiet --locked --package paper
	$(CARGO) run --quiet --locked --package validation
	verification/paper/draw.sh

## identification: fit 200 computed data sets of each kind, and write the tables of docs/identification.md (half an hour)
identification:
	MICROSLIP_FITS=200 $(CARGO) test --quiet --locked --package microslip-fit

## host: build CalculiX with the law as one of its elements, and compare its results with the library (some minutes)
host: all
	@tools/dependencies.sh host
	examples/calculix/run.sh dist

## fuzz: fuzz the C interface with TIME= seconds, JOBS= processes at once
fuzz:
	@tools/dependencies.sh fuzz
	tools/fuzz.sh

## python: build the Python wheel into target/python and test it
python:
	@tools/dependencies.sh python
	tools/python.sh all

## header: generate include/microslip.h and whatever else follows from the Rust source and tools/xtask/interface.txt
header:
	$(CARGO) run --quiet --package xtask -- header

## docs: the reference of the interfaces in C and Fortran, and of the Rust functions, into target/docs
docs:
	@tools/dependencies.sh docs
	tools/docs.sh

## dist: the source as target/microslip-VERSION.tar.gz, which builds without a network
dist:
	tools/tarball.sh target/microslip-$(version).tar.gz

## recipes: recipes of conda-forge and Spack for the tarball, published at URL=; BUILD=1 builds and tests the conda package
recipes:
	tools/recipes.sh $(URL)

## release: build all artefacts into target/publish, each tested as it is installed; URL= of the tarball; half an hour or more
release:
	tools/release.sh $(URL)

## clean: remove everything that was built
clean:
	rm -rf dist target
	$(MAKE) -C fortran_examples clean
	$(MAKE) -C verification/benches clean
	rm -rf examples/build examples/calculix/build examples/nlvib/build

## help: list the targets
help:
	@sed -n 's/^## //p' $(MAKEFILE_LIST)
