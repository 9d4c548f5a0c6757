# RQE over tau and over alpha at several sigma, each curve from its least. Usage: gnuplot -e "data='out/figures'" fig6.gp
if (!exists("data")) data = '.'
set terminal svg size 1000,420 font "sans,12"
set output data.'/fig6.svg'
set multiplot layout 1,2
set ylabel 'H - least [nat]'
set key top center
array sigma[5] = ['0.1 m', '0.2 m', '0.5 m', '1 m', '2 m']
array least[5]
do for [k = 1:5] { stats data.'/fig6_tau.dat' using (column(k + 1)) nooutput; least[k] = STATS_min }
set xlabel 'tau [m]'
plot for [k = 1:5] data.'/fig6_tau.dat' using 1:(column(k + 1) - least[k]) with lines title 'sigma '.sigma[k]
do for [k = 1:5] { stats data.'/fig6_alpha.dat' using (column(k + 1)) nooutput; least[k] = STATS_min }
set xlabel 'alpha [deg]'
plot for [k = 1:5] data.'/fig6_alpha.dat' using 1:(column(k + 1) - least[k]) with lines title 'sigma '.sigma[k]
unset multiplot
