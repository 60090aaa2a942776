# compare.awk RELATIONS RECORDED COUNTS: hold the counts against the record, and against each other.

FNR == 1 { ++file }

# Both tables say in "# key: value" what they depend on.
file > 1 && /^# [a-z]+: / {
    key = $2
    sub(/^# [a-z]+: /, "")
    if (file == 2) {
        host[key] = $0
    } else if (host[key] != $0) {
        others = others sprintf("  %s %s, recorded with %s\n", key, $0, host[key])
    }
    next
}

file == 1 && /^# -----/ { wanted_from = relations + 1 }
/^#/ || NF == 0 { next }

file == 1 { relation[++relations] = $0 }
file == 2 { recorded[$1] = $2; order[++cases] = $1 }
file == 3 {
    count[$1] = $2
    if (!($1 in recorded)) order[++cases] = $1
}

END {
    printf "%-42s %12s %12s\n", "case", "instructions", "recorded"
    for (i = 1; i <= cases; ++i) compare(order[i])
    if (others != "") {
        printf "\nCounted with\n%sso a difference from the record is told above, and fails nothing.\n", others
    }
    print ""
    for (i = 1; i <= relations; ++i) relate(relation[i], wanted_from && i >= wanted_from)
    if (below) printf "\n%d of the counts are below their record: please record them (make instructions-record).\n", below
    printf "%d passed, %d failed\n", passed, failed
    exit failed > 0
}

# A count may be 5 % above its record, and 20 instructions: the arguments of a call, which another C compiler lays otherwise.
function compare(name,    change, says, bad) {
    change = ""
    if (!(name in count)) {
        says = "MISSING"
        bad = 1
    } else if (!(name in recorded)) {
        says = "new: please record"
    } else {
        change = sprintf("%+.1f %%", 100 * (count[name] / recorded[name] - 1))
        if (count[name] > 1.05 * recorded[name] + 20) {
            says = "ABOVE"
            bad = others == ""
        } else if (count[name] < 0.95 * recorded[name] - 20) {
            says = "below: please record"
            ++below
        }
    }
    bad ? ++failed : ++passed
    printf "%-42s %12s %12s %9s  %s\n", name, count[name], recorded[name], change, says
}

function relate(line, wanted,    part, term, n, i, right, known, holds) {
    split(line, part, /: | < | [*] | because /)
    n = split(part[4], term, / [+] /)
    known = part[2] in count
    for (i = 1; i <= n; ++i) {
        known = known && (term[i] in count || term[i] ~ /^[0-9]+$/)
        right += term[i] in count ? count[term[i]] : term[i]
    }
    holds = known && count[part[2]] < part[3] * right
    if (!wanted) holds ? ++passed : ++failed
    printf "%-8s %8s < %-5s %s: %s of %s%s\n", wanted ? (holds ? "MOVE UP" : "wanted") : (holds ? "holds" : "NOT SO"),
        known ? sprintf("%.3f", count[part[2]] / right) : "-", part[3], part[1], part[2], part[4],
        holds ? "" : ", because " part[5]
}
