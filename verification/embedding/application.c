/* application.c: prints the hash of all results, also with as many other contacts as the argument says. The calls do not change errno, the rounding mode or the floating-point traps. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* feenableexcept */
#endif
#include <microslip.h> /* depends on no other header and may be included twice */

#include "calls.h"

#include <errno.h>
#include <fenv.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    const int traps = fegetexcept(); /* none under valgrind */
    errno = ERANGE;
    const uint64_t hash = hash_of_all(argc > 1 ? atoi(argv[1]) : 0);
    if (errno != ERANGE || fegetexcept() != traps || fegetround() != FE_TONEAREST) {
        fputs("errno, traps or rounding mode were changed\n", stderr);
        return 1;
    }
    return printf("%016" PRIx64 "\n", hash) < 0;
}
