#!/bin/sh
# model.sh: writes the input of CalculiX into the working directory. Millimetres, newtons, tonnes, seconds.
#
# A blade of 120 x 40 x 6, clamped at x = 0, is bent by a force in z at its tip. At x = 20, in the middle of its lower
# face, a contact in z connects it to a fixed node. 12 x 2 x 1 elements with incompatible modes.
#
#   blade.inp      mesh, contact, supports: included by the others
#   law.inp        constants of the contact: a, R, L, N, mu, E1, nu1, E2, nu2
#   static.inp     cyclic loads, a step each, in increments that CalculiX chooses
#   resumed.inp    the last three of these steps, from a restart file of the fourth
#   dynamic.inp    a force of constant frequency between the first resonances of the sliding and of the sticking blade
#   frequency.inp  natural frequencies of the sticking blade
#   matrices.inp   stiffness and mass of the blade alone, for compare.py
#   *_load.csv     force at the tip over time, linear in between
#   lifting.inp, lifting_dynamic.inp
#                  the same blade on the element with a normal direction: forces in y and z; the loads are time, y, z
#   orbit.inp, orbit_dynamic.inp
#                  the same on the element that slides in y and x; the loads are time, x, y, z
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

cat > law.inp << 'END'
*USER MATERIAL, CONSTANTS=9
0., 50., 3., 800., 0.5, 114.e3, 0.33, 114.e3,
0.33
END

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

# 44 state variables: 3 results, and a state that holds 12 reversals exactly.
cat > blade.inp << 'END'
*INCLUDE, INPUT=blade_alone.inp
*USER ELEMENT, TYPE=U1, NODES=2, INTEGRATION POINTS=1, MAXDOF=3
*ELEMENT, TYPE=U1, ELSET=rubbing
5000, 5000, 103
*MATERIAL, NAME=law
*INCLUDE, INPUT=law.inp
*DEPVAR
44
*USER SECTION, ELSET=rubbing, MATERIAL=law, CONSTANTS=3
0., 0., 1.
*INCLUDE, INPUT=for_restart.inp
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

# step LOAD: a static step to this load.
step() {
    printf '%s\n' '*STEP, INC=500' '*STATIC' '0.3, 1., 1.e-5, 0.3' "$controls" '*RESTART, WRITE' \
        '*CLOAD' "113, 3, $1." "$output" '*END STEP'
}

# Gross slip in both directions and small loops; and again from the end of the fourth step.
{
    printf '%s\n' '*INCLUDE, INPUT=blade.inp' "$tip"
    for load in 75 -75 50 -35 45 -75 75; do step "$load"; done
} > static.inp
{
    echo '*RESTART, READ, STEP=4'
    for load in 45 -75 75; do step "$load"; done
} > resumed.inp

# Five periods of 380 Hz, 200 increments each; the trapezoidal rule.
awk 'BEGIN {
    for (n = 0; n <= 1000; n++) printf "%.12g, %.12g\n", n/76000, 8*sin(2*atan2(0, -1)*n/200)
}' > dynamic_load.csv
{
    printf '%s\n' '*INCLUDE, INPUT=blade.inp' "$tip" '*AMPLITUDE, NAME=force' '*INCLUDE, INPUT=dynamic_load.csv' \
        '*STEP, INC=2000' '*DYNAMIC, DIRECT, ALPHA=0.' '1.31578947368e-5, 1.31578947368e-2' "$controls" \
        '*CLOAD, AMPLITUDE=force' '113, 3, 1.' "$output" '*END STEP'
} > dynamic.inp

printf '%s\n' '*INCLUDE, INPUT=blade.inp' '*STEP' '*FREQUENCY' '4' '*END STEP' > frequency.inp
printf '%s\n' '*INCLUDE, INPUT=blade_alone.inp' '*STEP' '*FREQUENCY, SOLVER=MATRIXSTORAGE' '4' '*END STEP' > matrices.inp

# The element with a normal direction: the contact slides in y and closes in -z. 273 state variables: 5 results, and a state that
# holds 64 pieces exactly: a normal force that rises in as many increments leaves as many.
cat > element.inp << 'END'
*USER MATERIAL, CONSTANTS=10
0., 50., 3., 800., 0.5, 114.e3, 0.33, 114.e3,
0.33, 0.
END

# blade_on STATE_VARIABLES DIRECTION FILE: the blade on the element with the constants in this file, which slides in this direction.
blade_on() {
    cat << END
*INCLUDE, INPUT=blade_alone.inp
*USER ELEMENT, TYPE=U1, NODES=2, INTEGRATION POINTS=1, MAXDOF=3
*ELEMENT, TYPE=U1, ELSET=rubbing
5000, 5000, 103
*MATERIAL, NAME=law
*INCLUDE, INPUT=$3
*DEPVAR
$1
*USER SECTION, ELSET=rubbing, MATERIAL=law, CONSTANTS=6
$2, 0., 0., -1.
END
}
blade_on 273 '0., 1., 0.' element.inp > lifting_blade.inp

# Pressed, loaded sideways beyond gross slip, unloaded, lifted, pressed again while displaced, and slid back.
lifting='0,0 0,-40 400,-40 400,-15 100,20 -300,20 -300,-40 -450,-40 300,-25 0,-40'
n=0
for load in $lifting; do printf '%d., %s.\n' "$n" "$(echo "$load" | sed 's/,/., /')"; n=$((n + 1)); done > lifting_load.csv
{
    printf '%s\n' '*INCLUDE, INPUT=lifting_blade.inp' "$tip"
    for load in ${lifting#* }; do
        printf '%s\n' '*STEP, INC=500' '*STATIC' '0.1, 1., 1.e-5, 0.1' "$controls" \
            '*CLOAD' "113, 2, ${load%,*}." "113, 3, ${load#*,}." "$output" '*END STEP'
    done
} > lifting.inp

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
sed 's/=10/=11/; $s/$/, 2./' element.inp > two_directions.inp
blade_on 1715 '0., 1., 0.' two_directions.inp > orbit_blade.inp
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
