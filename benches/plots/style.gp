# Shared by all pictures: error across, time up, one line a method. Colours are safe for colour-blind readers (Okabe and
# Ito); marks and dashes differ too, so that the lines can be told apart in grey.
set datafile separator ','
set encoding utf8

set style line 1 lc rgb '#0072B2' lw 2.4 dt 1       pt 7  ps 1.0  # microslip
set style line 2 lc rgb '#0072B2' lw 2.4 dt (6,3)   pt 6  ps 1.0  # microslip, other rule
set style line 3 lc rgb '#D55E00' lw 1.6 dt 1       pt 5  ps 0.8  # closed form
set style line 4 lc rgb '#009E73' lw 1.6 dt (8,4)   pt 9  ps 1.0  # Eq. 10, fixed
set style line 5 lc rgb '#009E73' lw 1.6 dt 1       pt 8  ps 1.0  # Eq. 10, adaptive
set style line 6 lc rgb '#555555' lw 1.6 dt 1       pt 11 ps 1.0  # sliders
set style line 7 lc rgb '#555555' lw 1.6 dt (2,3)   pt 10 ps 1.0  # sliders by reversals
set style line 8 lc rgb '#000000' lw 1.6 dt 1       pt 3  ps 1.1  # Jenkins
set style line 9 lc rgb '#000000' lw 1.2 dt (2,3)   pt 2  ps 1.0  # Jenkins by reversals

set border lw 1.0 lc rgb '#444444'
set grid lc rgb '#d8d8d8' lw 0.6 dt 1
set tics textcolor rgb '#222222'
set logscale xy
set format '10^{%T}'
set xrange [1e-17:10]
set xtics 1e-16, 1e4, 1 textcolor rgb '#222222'
set bars 0.6
set mxtics 1

# Rows of one task, case and method: error, median, and the 10th and 90th percentile in ns. Errors of 0 are drawn at 1e-17.
rows(task, shape, amplitude, harmonics, jacobian, method) = sprintf( \
  "< awk -F, -v OFS=, '$1 == \"%s\" && $2 == %g && $3 == %g && $4 == %d && $6 == %d && $7 == \"%s\" \
     { e = $9 + 0; if (e < 1e-17) e = 1e-17; print e, $11, $12, $13 }' %s/bench.csv", \
  task, shape, amplitude, harmonics, jacobian, method, results)

# Terminal and file of one picture: `extension` is svg or png, `name` the picture, sizes in points.
set_terminal = " \
  if (extension eq 'svg') { \
    set terminal svg size wide, high dynamic background rgb 'white' font 'Helvetica,14' \
  } else { \
    set terminal pngcairo size 1.6*wide, 1.6*high background rgb 'white' font 'Helvetica,14' \
      fontscale 1.6 linewidth 1.6 pointscale 1.6 \
  }; \
  set output sprintf('%s/%s.%s', results, name, extension)"
