#!/bin/sh
# draw.sh [GNUPLOT]: draws the pictures of docs/figures from the data of `paper` and `validation` in target/figures, and from what the
# command line computes here: a damper and its spring-slider, loops with layers, a fit of two noisy loops.
set -eu
cd "$(dirname "$0")"
: "${CARGO:=cargo}"
"$CARGO" build --quiet --locked --package microslip-cli
root=$(cd ../.. && pwd)
program=$root/target/debug/microslip
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

numbers() {
    grep -e '^[a-z]' -e '^[0-9]'
}

"$program" example > "$work/damper.toml"
"$program" contact "$work/damper.toml" | awk -F, '/^slip_|^initial_/ { print $1 " = " $2 }' > "$work/damper"
slip=$(sed -n 's/^slip_displacement = //p' "$work/damper")
"$program" jenkins "$work/damper.toml" --amplitude "$slip" | # the spring-slider of equal complex stiffness at gross slip
    awk -F, '/^[0-9]/ { print "tuned_stiffness = " $2 "; tuned_force = " $3 }' | cat "$work/damper" - > "$root/target/figures/why.gp"
"$program" loop "$work/damper.toml" --relative --amplitude 0.8 --points 201 | numbers > "$root/target/figures/why_loop.csv"
"$program" stiffness "$work/damper.toml" --relative --from 0.05 --to 5 | numbers > "$root/target/figures/why_stiffness.csv"
make -s -C "$root/fortran_examples" demo-cylinder demo-spring_slider PREFIX=../dist > "$work/demo"

sed -e 's/^flat_half_width.*/flat_half_width = 0.5e-3/; s/^edge_radius.*/edge_radius = 3e-3/; s/^length.*/length = 20e-3/' \
    -e 's/^friction.*/friction_coefficient = 0.5/; s/^young.*/young_modulus = 200e9/; s/^poisson.*/poisson_ratio = 0.3/' \
    "$work/damper.toml" > "$work/contact.toml"
stiffness=$("$program" contact "$work/contact.toml" | awk -F, '$1 == "initial_stiffness" { print $2 }')
normal_force=$(sed -n 's/^normal_force = \([0-9.e]*\).*/\1/p' "$work/contact.toml")
for share in 0 0.3 1 3; do
    for load in 0 0.05; do
        layer="--tangential-compliance $(awk "BEGIN { print $share / $stiffness }")"
        layer="$layer --stiffening-load $(awk "BEGIN { print $load * $normal_force }")"
        # Amplitude of the force: 0.9 mu N; of the displacement, in um, 0.01 to 10.
        # shellcheck disable=SC2086  # options
        amplitude=$("$program" curve "$work/contact.toml" $layer --force "$(awk "BEGIN { print 0.45 * $normal_force }")" |
            awk -F, '/^[0-9]/ { print $1 }')
        # shellcheck disable=SC2086
        "$program" loop "$work/contact.toml" $layer --amplitude "$amplitude" --points 201 |
            numbers > "$root/target/figures/loop_${share}_$load.csv"
        # shellcheck disable=SC2086
        "$program" stiffness "$work/contact.toml" $layer --from 1e-8 --to 1e-5 |
            numbers > "$root/target/figures/stiffness_${share}_$load.csv"
    done
done

for plot in plots/*.gp ../validation/plots/*.gp; do
    case $plot in */style.gp | */complex_stiffness.gp) continue ;; esac
    name=$(basename "$plot" .gp)
    "${1:-gnuplot}" -e "name = '$name'" plots/style.gp "$plot" > "$work/picture"
    python3 "$root/tools/svg.py" < "$work/picture" > "$root/docs/figures/$name.svg"
done

# A rig of 5e-9 m/N in series; noise of 0.03 N and 0.3 nm (Lehmer's generator; Box and Muller); amplitudes of 0.7 and 2 slip
# displacements of the contact. The start values of friction and flat are wrong by design.
contact="$work/contact.toml --edge-radius 50e-3 --length 2e-3 --normal-force 80"
for amplitude in 0.7 2; do
    # shellcheck disable=SC2086  # options
    "$program" loop $contact --flat-half-width 1e-4 --relative --amplitude "$amplitude" --points 200 |
        awk -F, -v series=5e-9 -v state="${amplitude#*.}1" '
            function uniform() { state = (state * 16807) % 2147483647; return state / 2147483647 }
            function noise() { return sqrt(-2 * log(uniform())) * cos(6.283185307 * uniform()) }
            /^amplitude/ { print "displacement [um],force [N]" }
            /^[0-9]/ { printf "%.5f,%.4f\n", 1e6 * ($2 + series * $3) + 3e-4 * noise(), $3 + 0.03 * noise() }
        ' > "$work/loop$amplitude.csv"
done
# shellcheck disable=SC2086
"$program" fit $contact --friction-coefficient 0.3 --flat-half-width 5e-5 \
    --measured "$work/loop0.7.csv,$work/loop2.csv" --data-units um,N --plot "$root/docs/figures/identification.svg"
