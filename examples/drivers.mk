# Drivers of user subroutines, included by the makefiles of abaqus/ and ansys/.
#
#   make test PREFIX=...    compile templates and driver twice, and run them: with checks and floating-point traps; with OpenMP
#   make clean
#
# PREFIX is the installation of microslip; the driver needs LAPACK. TEMPLATES are in fixed form, MODULES in free form.

PREFIX ?= ../../dist
FC ?= gfortran
ifeq ($(origin FC),default)
FC = gfortran
endif
WARNINGS = -Wall -Wextra -Werror
# The argument lists of the templates are prescribed, and Abaqus declares a parameter that they do not use.
PRESCRIBED = -Wno-unused-dummy-argument -Wno-unused-parameter
FLAGS_checked = -O1 -g -fcheck=all,no-array-temps -ffpe-trap=invalid,zero,overflow
FLAGS_openmp = -O2 -fopenmp
SOURCES = $(abspath $(PREFIX)/include/microslip.f90 ../contact_point.f90 $(MODULES) ../../tests/fortran/checks.f90 ../host.f90 driver.f90)

.PHONY: test clean always
.DELETE_ON_ERROR:

# Without OpenMP each call initialises its element, with it each thread keeps its elements: the results are the same.
test: build/checked/driver build/openmp/driver
	cd build/checked && ./driver > output || { cat output; exit 1; }
	cd build/openmp && OMP_NUM_THREADS=3 OMP_WAIT_POLICY=passive ./driver > output || { cat output; exit 1; }
	cmp build/checked/output build/openmp/output
	cat build/checked/output

# Always, for another PREFIX may have an older library.
build/%/driver: always
	rm -rf build/$* && mkdir -p build/$*
	cd build/$* && $(FC) $(FLAGS_$*) -std=f2008 -pedantic $(WARNINGS) -c $(SOURCES)
	$(if $(TEMPLATES),cd build/$* && $(FC) $(FLAGS_$*) $(WARNINGS) $(PRESCRIBED) -c $(abspath $(TEMPLATES)))
	cd build/$* && $(FC) $(FLAGS_$*) *.o $(abspath $(PREFIX))/lib/libmicroslip.a -llapack -lblas -lm -o driver

clean:
	rm -rf build
