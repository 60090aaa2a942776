# awk -f compare_tables.awk STORED FOUND: compares two CSV tables. The second line of STORED, "# tolerance,...", has for each column
# the allowed relative difference, or after "abs" the absolute one; 0 requires equal text.
BEGIN { FS = ","; worst = 0 }
FNR == NR && FNR == 2 { for (i = 2; i <= NF; i++) tolerance[i - 1] = $i; next }
FNR == NR { stored[rows++] = $0; next }
{
    columns = split(stored[FNR - 1], expected)
    if (FNR == 1) split($0, name)
    if (NF != columns) stop("row " FNR - 1 " has " NF " columns, expected " columns)
    for (i = 1; i <= NF; i++) {
        if ($i == expected[i]) continue
        allowed = tolerance[i]
        scale = expected[i] < 0 ? -expected[i] : expected[i]
        if (sub(/^abs /, "", allowed)) scale = 1
        difference = $i - expected[i]
        if (difference < 0) difference = -difference
        if (FNR == 1 || !(expected[i] ~ /^ *[-+0-9.]/) || !(difference <= allowed * scale))
            stop("row " FNR - 1 ", column " name[i] ": " $i ", expected " expected[i] " within " tolerance[i])
        if (difference > worst * allowed * scale) worst = difference / (allowed * scale)
    }
}
END {
    if (failed) exit 1
    if (FNR != rows || rows < 2) stop(FNR - 1 " rows, expected " rows - 1)
    printf "%s: %d rows, largest difference %.1e of the tolerance\n", FILENAME, rows - 1, worst
}
function stop(message) { failed = 1; print "error: " FILENAME ": " message; exit 1 }
