# awk -f compare_tables.awk STORED FOUND: compares two CSV tables. The second line of STORED, "# tolerance,...", has for each column
# the allowed relative difference, or after "abs" the absolute one; 0 requires equal text.
BEGIN { FS = ","; worst = 0 }
FNR == NR && FNR == 2 { for (i = 2; i <= NF; i++) tolerance[i - 1] = $i; next }
FNR == NR { stored[++rows] = $0; next }
{
    if (split(stored[FNR], expected) != NF) stop("row " FNR " has " NF " columns")
    for (i = 1; i <= NF; i++) {
        if ($i == expected[i]) continue
        allowed = tolerance[i]
        if (!sub(/^abs /, "", allowed)) allowed *= expected[i]
        ratio = ($i - expected[i])^2
        if (FNR == 1 || !(ratio <= allowed^2)) stop("row " FNR ", column " i ": " $i ", expected " expected[i] " within " tolerance[i])
        if (ratio > worst * allowed^2) worst = ratio / allowed^2
    }
}
END {
    if (failed || FNR != rows) exit 1
    printf "%s: %d rows, largest difference %.1e of the tolerance\n", FILENAME, rows - 1, sqrt(worst)
}
function stop(message) { failed = 1; print "error: " FILENAME ": " message; exit 1 }
