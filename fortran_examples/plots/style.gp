# Shared by all pictures. Colours are safe for colour-blind readers (Okabe and Ito, viridis); lines differ in dash,
# width and mark too, so that they are distinct in grey. One colour has one meaning in all panels of a picture. gnuplot computes the
# margins from the labels.
set datafile separator ','
set datafile missing 'nan'
set datafile columnheaders
set encoding utf8

set style line 1 lc rgb '#0072B2' lw 2.2 dt 1     pt 7 ps 0.8    # microslip, cylinder
set style line 3 lc rgb '#222222' lw 1.6 dt (2,3) pt 8 ps 1.0    # spring-slider

set border lw 1.0 lc rgb '#444444'
set grid lc rgb '#d8d8d8' lw 0.6 dt 1
set tics textcolor rgb '#222222'

micro(x) = 1e6 * x

# Terminal and file of a picture: `name`, sizes in points.
set_terminal = "set terminal svg size wide, high dynamic background rgb 'white' font 'Helvetica,14'; \
  set output sprintf('results/%s.svg', name)"
