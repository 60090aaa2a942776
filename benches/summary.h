/* summary.h: what the entries say about the targets, and the table of the README. */
#ifndef SUMMARY_H
#define SUMMARY_H

#include <stdio.h>

void summary_write(FILE *file);
void table_write(FILE *file);

#endif
