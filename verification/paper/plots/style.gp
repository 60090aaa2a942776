# Loaded before each picture, whose name is `name`. Colours are safe for colour-blind readers (Okabe and Ito), and lines also differ
# in dash and width. Titles are the names of the columns.
set datafile separator ','
set datafile columnheaders
set encoding utf8

set style line 1 lc rgb '#000000' lw 2.4 dt 1
set style line 2 lc rgb '#D55E00' lw 2.4 dt (10,4)
set style line 3 lc rgb '#0072B2' lw 2.4 dt (3,3)
set style line 4 lc rgb '#009E73' lw 2.0 dt (12,3,2,3)
set style line 5 lc rgb '#CC79A7' lw 2.6 dt 1
set style line 6 lc rgb '#56B4E9' lw 2.0 dt (6,2,2,2,2,2)
set style line 11 lc rgb '#777777' lw 1.2 dt 1        # for comparison
set style line 12 lc rgb '#777777' lw 1.4 dt (2,3)    # for comparison

set border lw 1.0 lc rgb '#444444'
set grid lc rgb '#d8d8d8' lw 0.6 dt 1
set tics textcolor rgb '#222222'
set key samplen 4.5 spacing 1.25 Left reverse

file(name) = sprintf('../../target/figures/%s.csv', name)

# The quantities, as in the paper: displacement and energy in the units of Eq. 10 and 16.
displacement = 'displacement  δ π E^* / (2 μ P)'
amplitude    = 'displacement amplitude  δ_0 π E^* / (2 μ P)'
force        = 'tangential force  Q / μP'
energy       = 'energy per cycle  E π E^* / (2 (μP)^2 L)'
place        = 'x / b'

# `wide` and `high` are in points. The picture goes to standard output.
set_terminal = "set terminal svg size wide, high dynamic background rgb 'white' font 'Helvetica,14'"
