#!/bin/sh
# Runs every case and draws the pictures; argument: the gnuplot to use.
set -eu
gnuplot=${1:-gnuplot}
start=$(date +%s)
mkdir -p results

build/blade_model check model
for case in cylinder flat spring_slider two_dof; do
  build/forced_response "cases/$case.nml" results
done
build/time_integration cases/newmark.nml results
build/time_integration cases/newmark_optimum.nml results
for script in plots/response.gp plots/optimum.gp plots/loops.gp plots/newmark.gp; do
  "$gnuplot" "$script"
done
echo
build/law_wall_time cases/cylinder.nml results

echo
echo "Written to $(pwd)/results:"
ls -1 results/*.csv results/*.svg results/*.png
echo "Wall time of the demonstration: $(($(date +%s) - start)) s"
