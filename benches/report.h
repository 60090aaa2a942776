/* report.h: checks of the errors, and tables, from all entries. */
#ifndef REPORT_H
#define REPORT_H

#include <stdio.h>

void check_errors(void);
void write_tables(FILE *file, const char *machine);
void write_details(FILE *file);

#endif
