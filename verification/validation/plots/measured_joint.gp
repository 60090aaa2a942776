# Frequency and damping of a bolted beam over the amplitude, measured and fitted; python/examples/measured_joint.py writes the data.
wide = 1100; high = 620

@set_terminal
set multiplot layout 2, 3
table = '../../docs/measured_joint.csv'
titles = '"mode 2" "mode 1" "mode 1, steady sweeps"'
of(part, i) = column(1) == part ? column(i) : NaN
set logscale x
set format x '%g'
set xtics (0.1, 0.3, 1, 3, 10, 30, 100, 300)
do for [row = 0:1] {
    set xlabel row ? 'amplitude [µm]' : ''
    do for [part = 0:2] {
        set xrange [word('0.05 1.2 15', part + 1) + 0:word('3 80 400', part + 1) + 0]
        set title row ? '' : word(titles, part + 1)
        set ylabel part ? '' : row ? 'damping ratio [%]' : 'frequency [Hz]'
        if (row || part) { set key off } else { set key on bottom left samplen 3 font ',12' }
        cell(i) = of(part, i + row) * (row ? 100 : 1)
        plot table using 2:(cell(7)) with lines ls 1 title 'law', \
             '' using 2:(cell(5)) with lines ls 2 title 'spring-slider', \
             '' using 2:(cell(9)) with lines ls 3 title 'best spread', \
             '' using 2:(cell(3)) with points pt 7 ps 0.8 lc rgb '#009E73' title 'measured'
    }
}
unset multiplot
