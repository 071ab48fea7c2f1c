/* Preloaded into a program: sets the direction of rounding before it begins. Threads inherit it. */
#include <fenv.h>
#include <stdlib.h>
#include <string.h>

__attribute__((constructor)) static void set_direction(void) {
    const char *direction = getenv("ROUNDING");
    int mode = FE_TONEAREST;
    if (direction == NULL) return;
    if (strcmp(direction, "upward") == 0) mode = FE_UPWARD;
    if (strcmp(direction, "downward") == 0) mode = FE_DOWNWARD;
    if (strcmp(direction, "towards zero") == 0) mode = FE_TOWARDZERO;
    if (fesetround(mode) != 0) abort();
}
