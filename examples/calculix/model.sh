#!/bin/sh
# model.sh: writes the input of CalculiX into the working directory. Millimetres, newtons, tonnes, seconds.
#
# A blade of 120 x 40 x 6, clamped at x = 0, is loaded by forces at its tip. At x = 20, in the middle of its lower face, a contact
# connects it to a fixed node: it slides in y and closes in -z. 12 x 2 x 1 elements with incompatible modes.
#
#   element.inp    constants of the contact: a, R, L, N, mu, E1, nu1, E2, nu2, interference, directions
#   lifting.inp    forces in y and z, a step each, in increments that CalculiX chooses
#   resumed.inp    the last four of these steps, from a restart file of the fifth
#   rejected.inp   all of these steps, with rejected increments
#   lifting_dynamic.inp
#                  the same blade bounces
#   orbit.inp, orbit_dynamic.inp
#                  the contact slides in y and x
#   frequency.inp  natural frequencies of the sticking blade
#   matrices.inp   stiffness and mass of the blade alone, for compare.py
#   *_load.csv     time, and forces at the tip in y and z, or x, y and z, linear in between
set -eu

# Columns: x, then y, then z.
awk 'BEGIN {
    print "*NODE, NSET=all"
    for (k = 0; k <= 1; k++) for (j = 0; j <= 2; j++) for (i = 0; i <= 12; i++)
        printf "%d, %g, %g, %g\n", 1000*k + 100*j + i + 1, 10*i, 20*j, 6*k
    print "5000, 20., 20., 0."
    print "*ELEMENT, TYPE=C3D8I, ELSET=blade"
    for (j = 0; j < 2; j++) for (i = 0; i < 12; i++) {
        n = 100*j + i + 1
        printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", n, n, n + 1, n + 101, n + 100, n + 1000, n + 1001, n + 1101, n + 1100
    }
    print "*NSET, NSET=root"
    for (k = 0; k <= 1; k++) for (j = 0; j <= 2; j++) print 1000*k + 100*j + 1
}' > mesh.inp

cat > blade_alone.inp << 'END'
*INCLUDE, INPUT=mesh.inp
*MATERIAL, NAME=titanium
*ELASTIC
114.e3, 0.33
*DENSITY
4.43e-9
*SOLID SECTION, ELSET=blade, MATERIAL=titanium
*BOUNDARY
root, 1, 3
5000, 1, 3
END

# An open contact pair: without one, CalculiX 2.20 writes no state variables to a restart file.
cat > for_restart.inp << 'END'
*SURFACE, NAME=end, TYPE=ELEMENT
12, S2
*SURFACE, NAME=held, TYPE=NODE
5000
*SURFACE INTERACTION, NAME=never
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1., 1.
*CONTACT PAIR, INTERACTION=never, TYPE=NODE TO SURFACE
held, end
END

# Tolerances of residuals and corrections: the defaults, 5e-3 and 1e-2, would hide the differences to be found.
controls='*CONTROLS, PARAMETERS=FIELD
1.e-9, 1.e-9'
output='*NODE PRINT, NSET=tip
U
*EL PRINT, ELSET=rubbing
SDV'
tip='*NSET, NSET=tip
113'

printf '%s\n' '*INCLUDE, INPUT=blade_alone.inp' '*STEP' '*FREQUENCY, SOLVER=MATRIXSTORAGE' '4' '*END STEP' > matrices.inp

cat > element.inp << 'END'
*USER MATERIAL, CONSTANTS=11
0., 50., 3., 800., 0.5, 114.e3, 0.33, 114.e3,
0.33, 0., 1.
END

# blade_on STATE_VARIABLES FILE: the blade on the element with the constants in this file.
blade_on() {
    cat << END
*INCLUDE, INPUT=blade_alone.inp
*USER ELEMENT, TYPE=U1, NODES=2, INTEGRATION POINTS=1, MAXDOF=3
*ELEMENT, TYPE=U1, ELSET=rubbing
5000, 5000, 103
*MATERIAL, NAME=law
*INCLUDE, INPUT=$2
*DEPVAR
$1
*USER SECTION, ELSET=rubbing, MATERIAL=law, CONSTANTS=6
0., 1., 0., 0., 0., -1.
END
}
# 5 results, and a state that holds 64 pieces exactly: a normal force that rises in as many increments leaves as many.
{
    blade_on 273 element.inp
    echo '*INCLUDE, INPUT=for_restart.inp'
} > lifting_blade.inp
printf '%s\n' '*INCLUDE, INPUT=lifting_blade.inp' '*STEP' '*FREQUENCY' '4' '*END STEP' > frequency.inp

# Pressed, loaded sideways beyond gross slip, unloaded, lifted, pressed again while displaced, and slid back; and again from the fifth.
lifting='0,0 0,-40 400,-40 400,-15 100,20 -300,20 -300,-40 -450,-40 300,-25 0,-40'
n=0
for load in $lifting; do printf '%d., %s.\n' "$n" "$(echo "$load" | sed 's/,/., /')"; n=$((n + 1)); done > lifting_load.csv
# steps LOAD...: a static step to each load.
steps() {
    for load; do
        printf '%s\n' '*STEP, INC=500' '*STATIC' '0.1, 1., 1.e-5, 0.1' "$controls" '*RESTART, WRITE' \
            '*CLOAD' "113, 2, ${load%,*}." "113, 3, ${load#*,}." "$output" '*END STEP'
    done
}
# shellcheck disable=SC2086  # a list
{
    printf '%s\n' '*INCLUDE, INPUT=lifting_blade.inp' "$tip"
    steps ${lifting#* }
} > lifting.inp
# shellcheck disable=SC2086
{
    echo '*RESTART, READ, STEP=5'
    steps ${lifting#*-300,20 }
} > resumed.inp

# With at most three iterations in an increment, of which CalculiX rejects some.
sed 's/^1.e-9, 1.e-9$/&\n*CONTROLS, PARAMETERS=TIME INCREMENTATION\n2, 8, 9, 3, 10, 4, , 5/' lifting.inp > rejected.inp

# Four periods of 300 Hz across, of 200 Hz sideways: the blade bounces.
awk 'BEGIN {
    pi = atan2(0, -1)
    for (n = 0; n <= 1000; n++) { t = n/75000; printf "%.12g, %.12g, %.12g\n", t, 150*sin(2*pi*200*t), -8*sin(2*pi*300*t) }
}' > lifting_dynamic_load.csv
# driven JOB PROCEDURE TIMES DIRECTION...: a step in which each column of JOB_load.csv drives the tip in its direction.
driven() {
    job=$1 procedure=$2 times=$3
    shift 3
    printf '%s\n' "*INCLUDE, INPUT=${job%_dynamic}_blade.inp" "$tip"
    column=1
    for direction; do
        column=$((column + 1))
        printf '%s\n' "*AMPLITUDE, NAME=force$direction"
        cut -d , -f 1,$column "${job}_load.csv"
    done
    printf '%s\n' '*STEP, INC=2000' "$procedure" "$times" "$controls"
    for direction; do printf '%s\n' "*CLOAD, AMPLITUDE=force$direction" "113, $direction, 1."; done
    printf '%s\n' "$output" '*END STEP'
}
trapezoidal='*DYNAMIC, DIRECT, ALPHA=0.'
driven lifting_dynamic "$trapezoidal" '1.33333333333e-5, 1.33333333333e-2' 2 3 > lifting_dynamic.inp

# Two directions of sliding: y as before, and x. 1715 state variables: 7 results, and room for a state. Pressed, then a force that
# rotates twice in the plane of x and y while the normal force varies, two periods in each rotation.
sed '$s/1[.]$/2./' element.inp > two_directions.inp
blade_on 1715 two_directions.inp > orbit_blade.inp
awk 'BEGIN {
    pi = atan2(0, -1)
    print "0., 0., 0., 0."
    for (n = 0; n <= 100; n++)
        printf "%.12g, %.12g, %.12g, %.12g\n", 1 + n/50, 1000*cos(2*pi*n/50), 300*sin(2*pi*n/50), -50 - 15*sin(4*pi*n/50)
}' > orbit_load.csv
driven orbit '*STATIC' '0.02, 3., 1.e-5, 0.02' 1 2 3 > orbit.inp

# The first half of the dynamic loads above, and no force in x: bending drives the contact there.
sed 's/,/, 0.,/; 501q' lifting_dynamic_load.csv > orbit_dynamic_load.csv
driven orbit_dynamic "$trapezoidal" '1.33333333333e-5, 6.66666666667e-3' 1 2 3 > orbit_dynamic.inp
