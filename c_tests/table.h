/* table.h: tables of reference values, row by row. Include it first. */
#ifndef TABLE_H
#define TABLE_H

#include "check.h"

#include "outputs.h"
#include <stdlib.h>

enum { MAX_COLUMNS = 40 };

typedef struct table {
    FILE *file;
    const char *name;
    int line;
    int columns;
    const char *text[MAX_COLUMNS]; /* the cells of the row */
    double value[MAX_COLUMNS];     /* NaN in cells of text */
    char row[8192];
} table;

static const char *directory = "tests/golden";

/* [--trap] [DIRECTORY] */
static inline void table_arguments(int argc, char **argv)
{
    const int argument = check_arguments(argc, argv);
    if (argument < argc) {
        directory = argv[argument];
    }
}

/* Opens a table with these columns. */
static inline table open_table(const char *name, const char *columns)
{
    table t;
    char path[4096];
    char header[1024];

    t.name = name;
    t.line = 1;
    t.columns = 1;
    for (const char *c = columns; *c; ++c) {
        t.columns += *c == ',';
    }
    snprintf(path, sizeof path, "%s/%s.csv", directory, name);
    t.file = fopen(path, "r");
    if (!t.file || !fgets(header, sizeof header, t.file)) {
        fprintf(stderr, "%s cannot be read\n", path);
        exit(2);
    }
    header[strcspn(header, "\r\n")] = '\0';
    if (strcmp(header, columns) != 0 || t.columns > MAX_COLUMNS) {
        fprintf(stderr, "%s has other columns than %s\n", path, columns);
        exit(2);
    }
    return t;
}

/* Reads the next row; 0 at the end. A table has at least one row. */
static inline int next_row(table *t)
{
    if (!fgets(t->row, sizeof t->row, t->file)) {
        CHECK(t->line > 1);
        fclose(t->file);
        return 0;
    }
    ++t->line;
    char *next = t->row;
    for (int column = 0; column < t->columns; ++column) {
        const size_t length = strcspn(next, ",\n");
        if (length == 0 || next[length] != (column + 1 < t->columns ? ',' : '\n')) {
            fprintf(stderr, "%s: line %d is not a row of %d values\n", t->name, t->line, t->columns);
            exit(2);
        }
        next[length] = '\0';
        char *end;
        t->text[column] = next;
        t->value[column] = strtod(next, &end);
        if (*end != '\0') {
            t->value[column] = NAN;
        }
        next += length + 1;
    }
    return 1;
}

static inline void compare(const table *t, const char *what, double got, double want, double tolerance)
{
    char text[128];
    snprintf(text, sizeof text, "%s of the table", what);
    check_near(got, want, tolerance, t->name, t->line, text);
}

static inline void accepted(const table *t, int32_t status)
{
    check_that(status == MSLIP_OK, t->name, t->line, mslip_status_text(status));
}

#endif
