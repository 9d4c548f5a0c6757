# RQE over tau and alpha. Usage: gnuplot -e "data='out/figures'" fig5.gp
if (!exists("data")) data = '.'
set terminal svg size 700,520 font "sans,12"
set output data.'/fig5.svg'
set xlabel 'tau [m]'
set ylabel 'alpha [deg]'
set zlabel 'H [nat]' rotate
set hidden3d
set view 55,30
unset key
splot data.'/fig5_surface.dat' with lines lc rgb '#2060a0'
