# Makes a measured force curve of a computed one: columns displacement [nm], force [uN].
# k: stiffness of the instrument, N/m; sigma: noise, uN; before, after, step: points without contact and their distance, m;
# offset, nm; zero and drift from point to point, uN; seed of the noise.
function noise(  sum, i) { sum = -6; for (i = 0; i < 12; i++) { state = (state * 16807) % 2147483647; sum += state / 2147483647 } return sigma * sum }
function point(d, f) { number++; printf "%.3f,%.4f\n", 1e9 * d + offset, 1e6 * f + zero + drift * number + noise() }
BEGIN { FS = ","; state = 2025 + seed; print "displacement [nm],force [uN]"; for (i = 0; i < before; i++) point(-(before - i) * step, 0) }
/^[0-9]/ { jump = 1e9 * ($2 + $3 / k - $7); if (jump * jump < 1e-6) { point($7, $3); last = $7 } }
END { for (i = 1; i <= after; i++) point(last - i * step, 0) }
