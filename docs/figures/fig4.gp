# The cloud of one beam at no lag and at the lag of the least RQE. Usage: gnuplot -e "data='out/figures'" fig4.gp
if (!exists("data")) data = '.'
set terminal svg size 900,420 font "sans,12"
set output data.'/fig4.svg'
set multiplot layout 1,2
set size ratio -1
set xlabel 'x [m]'
set ylabel 'y [m]'
unset key
set title 'no lag'
plot data.'/fig4_beam.dat' index 0 with points pt 7 ps 0.2 lc rgb '#b03030'
set title 'lag of the least RQE'
plot data.'/fig4_beam.dat' index 1 with points pt 7 ps 0.2 lc rgb '#2060a0'
unset multiplot
