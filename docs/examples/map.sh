# Makes map.txt: heights in nm of a rough face of 20 µm × 20 µm, 64 × 64 points, with noise, as a microscope writes them.
awk 'function uniform() { state = (state * 16807) % 2147483647; return state / 2147483647 }
BEGIN {
    state = 2012; turn = 8 * atan2(1, 1); points = 64; last = 16
    for (k = 0; k <= last; k++) for (l = -last; l <= last; l++) {
        q = sqrt(k * k + l * l)
        if (q < 1 || q > last || (k == 0 && l < 0)) continue
        n++; across[n] = k; along[n] = l; height[n] = 60 * (q > 4 ? q : 4) ^ -1.8; phase[n] = turn * uniform()
    }
    print "# Width: 20 um\n# Height: 20 um\n# Value units: nm"
    for (i = 0; i < points; i++) for (j = 0; j < points; j++) {
        z = uniform() - 0.5
        for (m = 1; m <= n; m++) z += height[m] * cos(turn * (across[m] * i + along[m] * j) / points + phase[m])
        printf "%.1f%s", z, j + 1 < points ? "\t" : "\n"
    }
}' >map.txt
