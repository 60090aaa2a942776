/* check.h: counted checks, floating-point traps and the last line of each driver. Include it first. */
#ifndef CHECK_H
#define CHECK_H

#if defined(__linux__) && !defined(_GNU_SOURCE)
#define _GNU_SOURCE /* feenableexcept */
#endif
#include <microslip.h>
#include <fenv.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int checks_passed;
static int checks_failed;

static inline int check_that(int holds, const char *file, int line, const char *text)
{
    if (holds) {
        ++checks_passed;
    } else {
        ++checks_failed;
        printf("%s:%d: %s\n", file, line, text);
    }
    return holds;
}

/* The condition holds. */
#define CHECK(condition) check_that(!!(condition), __FILE__, __LINE__, #condition)

/* |got - want| <= tolerance. A NaN fails without being compared, which would trap. */
static inline int is_near(double got, double want, double tolerance)
{
    if (isinf(want)) {
        return isinf(got) && signbit(got) == signbit(want);
    }
    return isfinite(got) && fabs(got - want) <= tolerance;
}

static inline int check_near(double got, double want, double tolerance, const char *file, int line, const char *text)
{
    int holds = check_that(is_near(got, want, tolerance), file, line, text);
    if (!holds) {
        printf("    got %.17g, want %.17g, difference %.2g, allowed %.2g\n", got, want, got - want, tolerance);
    }
    return holds;
}

#define CHECK_NEAR(got, want, tolerance) check_near((got), (want), (tolerance), __FILE__, __LINE__, #got)
#define CHECK_RELATIVE(got, want, tolerance) CHECK_NEAR((got), (want), (tolerance) * fabs(want))

/* A flat of this half-width under 60 N, of two equal bodies. */
static inline mslip_parameters flat_parameters(double flat_half_width, double poisson_ratio)
{
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.flat_half_width = flat_half_width;
    p.edge_radius = 5e-3;
    p.length = 2e-2;
    p.normal_force = 60.0;
    p.friction_coefficient = 0.5;
    p.displacement_reference = MSLIP_CENTRE_POINT;
    p.material[0].young_modulus = p.material[1].young_modulus = 2e11;
    p.material[0].poisson_ratio = p.material[1].poisson_ratio = poisson_ratio;
    return p;
}

/* With `--trap`, invalid operations, divisions by zero and overflows end the program; on processors without traps, as most of the
   Arm architecture, they fail the last check. Returns the index of the next argument. */
static int checks_flags;
static inline int check_arguments(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--trap") == 0) {
#ifdef __GLIBC__
        feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
        checks_flags = fegetexcept() == 0;
#endif
        return 2;
    }
    return 1;
}

/* The last line, and the exit code. */
static inline int check_report(void)
{
    if (checks_flags) {
        CHECK(fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) == 0);
    }
    printf("%d passed, %d failed\n", checks_passed, checks_failed);
    return checks_failed != 0 || checks_passed == 0;
}

#endif
