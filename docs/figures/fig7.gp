# RQE of one beam over eta at several sigma, each curve from its least. Usage: gnuplot -e "data='out/figures'" fig7.gp
if (!exists("data")) data = '.'
set terminal svg size 700,460 font "sans,12"
set output data.'/fig7.svg'
set xlabel 'eta [ms]'
set ylabel 'H - least [nat]'
array sigma[4] = ['0.5 m', '0.04 m', '0.012 m', '0.001 m']
array least[4]
do for [k = 1:4] { stats data.'/fig7_eta.dat' using (column(k + 1)) nooutput; least[k] = STATS_min }
plot for [k = 1:4] data.'/fig7_eta.dat' using ($1*1e3):(column(k + 1) - least[k]) with lines title 'sigma '.sigma[k]
