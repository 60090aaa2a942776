/* masing.inc.h: Masing's rule with return-point memory over any monotonic curve, in any precision.
 *
 * Define REAL, WALK (prefix of the names) and CURVE(law, u, &stiffness), the force at 0 <= u < SLIP(law), before including;
 * FORCE(law) is the force in gross slip. */
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define NAME(x) JOIN(WALK, x)

enum { NAME(_deepest) = 64 };

typedef struct {
    const void *law;
    int depth, direction;
    REAL turn[NAME(_deepest)], turn_force[NAME(_deepest)];
    REAL centre; /* of the virgin curve: gross slip drags it along */
    REAL at, force, stiffness;
} NAME(_walk);

static void NAME(_start)(NAME(_walk) *walk, const void *law)
{
    *walk = (NAME(_walk)) { .law = law };
}

/* A leg in a direction begins. */
static void NAME(_turn)(NAME(_walk) *walk, int direction)
{
    if (walk->direction && direction != walk->direction && walk->depth < NAME(_deepest)) {
        walk->turn[walk->depth] = walk->at;
        walk->turn_force[walk->depth++] = walk->force;
    }
    walk->direction = direction;
}

/* Where the branch at hand ends: it meets an older one, its mirror image on the virgin curve, or gross slip. */
static REAL NAME(_end)(const NAME(_walk) *walk)
{
    if (walk->depth >= 2) {
        return walk->turn[walk->depth - 2];
    }
    return walk->depth == 1 ? 2 * walk->centre - walk->turn[0] : walk->centre + walk->direction * SLIP(walk->law);
}

static void NAME(_forget)(NAME(_walk) *walk)
{
    walk->depth -= walk->depth >= 2 ? 2 : 1;
}

/* Force on the branch at hand, which is not in gross slip. */
static REAL NAME(_on_branch)(const NAME(_walk) *walk, REAL u, REAL *stiffness)
{
    const int d = walk->direction;
    if (walk->depth == 0) {
        return d * CURVE(walk->law, d * (u - walk->centre), stiffness);
    }
    const int last = walk->depth - 1;
    return walk->turn_force[last] + 2 * d * CURVE(walk->law, d * (u - walk->turn[last]) / 2, stiffness);
}

static void NAME(_move)(NAME(_walk) *walk, REAL u)
{
    if (u == walk->at) {
        return;
    }
    const int d = u > walk->at ? 1 : -1;
    NAME(_turn)(walk, d);
    while (walk->depth && d * (u - NAME(_end)(walk)) >= 0) {
        NAME(_forget)(walk);
    }
    walk->at = u;
    if (walk->depth == 0 && d * (u - NAME(_end)(walk)) >= 0) {
        walk->force = d * FORCE(walk->law);
        walk->stiffness = 0;
        walk->centre = u - d * SLIP(walk->law);
    } else {
        walk->force = NAME(_on_branch)(walk, u, &walk->stiffness);
    }
}

#undef JOIN_
#undef JOIN
#undef NAME
