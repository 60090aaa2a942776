/* tasks.c: what the tasks share. */
#include "tasks.h"
#include "measure.h"

static void release(void *bank)
{
    sliders_free(bank);
}

const sliders *kept(sliders s)
{
    sliders *bank = context_of(sizeof *bank);
    *bank = s;
    release_later(bank, release);
    return bank;
}
