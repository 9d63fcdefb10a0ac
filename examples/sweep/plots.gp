# The pictures from what tables.sql writes:
#     gnuplot plots.gp
# reads error.csv, fps.csv and bytes.csv, writes sweep_error.png, sweep_fps.png and sweep_bytes.png.
set datafile separator comma
set grid lc rgb "#dddddd" lw 1
set border lc rgb "#666666"
set tics tc rgb "#333333"
has(list, name) = strstrt(" ".list." ", " ".name." ") > 0

# Error against cost: a bar for each scheme, from one card to the other.
set terminal pngcairo size 900,470 font "DejaVu Sans,9" fontscale 1
set output "sweep_error.png"
set multiplot layout 1,2 title "golem, 16 segments on an edge of a face of the cage" font ",11"
set logscale xy
set format y "10^{%T}"
set xlabel "predicted time of a frame's geometry, µs"
set xrange [0.3:8000]
set key at graph 0.02,0.52 top left reverse Left samplen 1.5 font ",8"
colour(rules) = rules eq "Catmull-Clark" ? 0x2563a8 : 0xd9731a
f = "error.csv"
do for [panel = 5:6] {
    # Names stand to the left or to the right of a bar, some a little higher or lower.
    if (panel == 5) {
        set title "position"
        set ylabel "RMS distance to the limit surface, diagonals"
        set yrange [1e-9:0.3]
        left = "phong gregory-two-stage biseptic tables-catmull-clark"
        up = "stam"
        down = "pm bolz"
    } else {
        set title "normal"
        set ylabel "RMS angle to the limit surface's normal, radians"
        set yrange [3e-8:3]
        unset key
        left = "flat gregory-two-stage"
        up = "phong tables-loop acc pm"
        down = "tables-catmull-clark"
    }
    dy(name) = has(up, name) ? 1 : has(down, name) ? -1 : 0
    label(name, side) = has(left, name) == (side < 0) ? name : ""
    shifted(name, shift) = dy(name) == shift ? label(name, 1) : ""
    plot f skip 1 using 3:panel:($4 - $3):(0):(colour(strcol(2))) \
             with vectors nohead lw 2 lc rgb variable notitle, \
         f skip 1 using 3:panel:(colour(strcol(2))) \
             with points pt 7 ps 0.9 lc rgb "white" notitle, \
         f skip 1 using 3:panel:(colour(strcol(2))) \
             with points pt 6 ps 0.9 lw 1.5 lc rgb variable notitle, \
         f skip 1 using 4:panel:(colour(strcol(2))) \
             with points pt 7 ps 0.9 lc rgb variable notitle, \
         f skip 1 using 3:panel:(label(strcol(1), -1)) \
             with labels right offset -0.9,0 font ",8" notitle, \
         for [s = -1:1] f skip 1 using 4:panel:(shifted(strcol(1), s)) \
             with labels left offset 0.9,0.55*s font ",8" notitle, \
         NaN with points pt 6 lw 1.5 lc rgb "#333333" title "Radeon HD 5870", \
         NaN with points pt 7 lc rgb "#333333" title "GeForce GTX 480", \
         NaN with lines lw 2 lc rgb 0x2563a8 title "from Catmull-Clark's surface", \
         NaN with lines lw 2 lc rgb 0xd9731a title "from Loop's or Butterfly's"
}
unset multiplot

# Frames a second against segments, a panel for each card.
set terminal pngcairo size 900,470 font "DejaVu Sans,9" fontscale 1
set output "sweep_fps.png"
set multiplot layout 1,2 title "golem, geometry alone, no overhead of a frame" font ",11"
schemes = "flat phong qas pn-triangles gregory-two-stage pm gregory-stencil acc bolz biseptic \
tables-catmull-clark tables-loop stam tables-butterfly"
colours = "#111111 #888888 #e3b505 #d9731a #0b4f9c #3d85c6 #7fb9ea #8e7cc3 #c2185b #2e8b57 \
#000000 #7a5c3a #d62728 #7fb069"
dashes = "1 2 1 2 1 1 1 1 1 1 3 2 1 1"
set xrange [1:64]
set yrange [100:2e7]
set xlabel "segments on an edge of a face of the cage"
set ylabel "frames a second"
set xtics (1, 2, 4, 8, 16, 32, 64)
do for [card in "gtx480 radeon5870"] {
    if (card eq "gtx480") {
        set title "GeForce GTX 480"
        set key at graph 0.02,0.02 bottom left reverse Left samplen 3 font ",8"
    } else {
        set title "Radeon HD 5870"
        unset key
    }
    plot for [i = 1:words(schemes)] "fps.csv" skip 1 \
        using (strcol(1) eq card && strcol(2) eq word(schemes, i) ? $3 : NaN):4 \
        with lines lw 2 dt int(word(dashes, i)) lc rgb word(colours, i) title word(schemes, i)
}
unset multiplot

# Bytes by stage.
reset
set datafile separator comma
set border lc rgb "#666666"
set terminal pngcairo size 900,400 font "DejaVu Sans,9" fontscale 1
set output "sweep_bytes.png"
set title "golem, 16 segments on an edge of a face of the cage" font ",11"
set style data histograms
set style histogram rowstacked
set style fill solid border lc rgb "white"
set boxwidth 0.75
set grid y lc rgb "#dddddd"
set ylabel "fetched in a frame, MB"
set yrange [0:80]
set xtics rotate by 35 right nomirror tc rgb "#333333"
set ytics tc rgb "#333333"
set key top left reverse Left invert
plot "bytes.csv" skip 1 using ($2 / 1e6):xtic(1) lc rgb "#777777" title "compute shader", \
     "" skip 1 using ($3 / 1e6) lc rgb "#e3b505" title "vertex shader", \
     "" skip 1 using ($4 / 1e6) lc rgb "#2e8b57" title "hull shader", \
     "" skip 1 using ($5 / 1e6) lc rgb "#2563a8" title "domain shader", \
     "" skip 1 using ($6 / 1e6) lc rgb "#c2185b" title "pixel shader"
