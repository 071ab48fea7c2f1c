# Makes a measured force curve with times of a computed one: columns time [s], displacement [nm], force [nN].
# points: points in contact; free: points before and after; speed, m/s; sigma: noise, nN; offset, nm; seed of the noise.
function noise(  sum, i) { sum = -6; for (i = 0; i < 12; i++) { state = (state * 16807) % 2147483647; sum += state / 2147483647 } return sigma * sum }
function point(t, d, f) { printf "%.6g,%.2f,%.3f\n", t, 1e9 * d + offset, 1e9 * f + noise() }
BEGIN { FS = ","; state = 2025 + seed; print "time [s],displacement [nm],force [nN]" }
/^[0-9]/ { n++; t[n] = $7; d[n] = $8; f[n] = $3 }
END {
    step = t[n] / points
    for (i = free; i > 0; i--) point(-i * step, -i * step * speed, 0)
    k = 2
    for (i = 0; i <= points; i++) {
        now = i * step
        while (k < n && t[k] < now) k++
        share = t[k] > t[k - 1] ? (now - t[k - 1]) / (t[k] - t[k - 1]) : 1
        point(now, d[k - 1] + share * (d[k] - d[k - 1]), f[k - 1] + share * (f[k] - f[k - 1]))
    }
    for (i = 1; i <= free; i++) point(t[n] + i * step, d[n] - i * step * speed, 0)
}
