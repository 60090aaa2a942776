/* host.c: the hash of everything that the library answers. */
#include <microslip.h> /* which needs nothing before it, and may come twice */

#include "use.h"

#include <inttypes.h>
#include <stdio.h>

int main(void)
{
    return printf("%016" PRIx64 "\n", visit_all()) < 0;
}
