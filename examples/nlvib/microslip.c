/* The library in Octave and MATLAB:
 *
 *   contact = microslip('contact', p)                             a contact under a constant normal force
 *   element = microslip('element', p, directions, normal_input)   a friction contact element: varying normal force, separation
 *   fields = microslip('fields', object)                          the named fields of a contact or an element
 *   approach = microslip('approach', element, force)              normal approach under normal forces
 *   [force, jacobian, dissipated, drift] = microslip('harmonic_force', object, samples, displacement, rule, periods)
 *
 * p is a struct with the fields of mslip_parameters; in place of material it has young_modulus and poisson_ratio, one value or one
 * for each body. A contact and an element are uint8 arrays, which may be saved. directions, 1, and
 * normal_input, MSLIP_INPUT_APPROACH, may be left out, so may rule, MSLIP_UNIFORM_SAMPLING, and periods, 0, the default.
 *
 * displacement has a column for each component, with 2H+1 rows [c0; cos1; sin1; cos2; ...], and so has the force; jacobian is
 * d force(:) / d displacement(:). What the library rejects is an error with its message and the identifier microslip:status. */
#include <mex.h>
#include <microslip.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static void check(int32_t status)
{
    if (status != MSLIP_OK) mexErrMsgIdAndTxt("microslip:status", "%s", mslip_status_text(status));
}

static void require(int holds, const char *message)
{
    if (!holds) mexErrMsgIdAndTxt("microslip:argument", "%s", message);
}

static double scalar(const mxArray *array, const char *message)
{
    require(mxIsDouble(array) && !mxIsComplex(array) && mxGetNumberOfElements(array) == 1, message);
    return mxGetScalar(array);
}

/* A count or a constant; a value out of range becomes 0 or -1, which the library rejects. */
static size_t count(const mxArray *array, const char *message)
{
    double value = scalar(array, message);
    return value >= 0 && value < 1e9 ? (size_t)value : 0;
}

static int32_t constant(const mxArray *array, const char *message)
{
    double value = scalar(array, message);
    return value >= 0 && value < 1e9 ? (int32_t)value : -1;
}

/* ---- Parameters ---- */

typedef struct field {
    const char *name;
    size_t offset;
} field;

#define FIELD(name) { #name, offsetof(mslip_parameters, name) }
#define LAYER(name) { #name, offsetof(mslip_parameters, layer.name) }

static const field known_fields[] = {
    FIELD(flat_half_width), FIELD(edge_radius), FIELD(length), FIELD(normal_force), FIELD(friction_coefficient),
    LAYER(normal_compliance), LAYER(tangential_compliance), LAYER(stiffening_load), LAYER(reference_load), { NULL, 0 }
};

static void read_material(const mxArray *values, double *first, double *second)
{
    size_t n = mxGetNumberOfElements(values);
    require(mxIsDouble(values) && !mxIsComplex(values) && (n == 1 || n == 2), "a property of the material is one value, or two");
    *first = mxGetPr(values)[0];
    *second = mxGetPr(values)[n - 1];
}

/* Fields that the struct does not have stay NaN; the library rejects them by name. */
static mslip_parameters read_parameters(const mxArray *p)
{
    mslip_parameters parameters;
    mslip_parameters_default(&parameters);
    require(mxIsStruct(p) && mxGetNumberOfElements(p) == 1, "the parameters are a struct");
    for (int i = 0; i < mxGetNumberOfFields(p); i++) {
        const char *name = mxGetFieldNameByNumber(p, i);
        const mxArray *value = mxGetFieldByNumber(p, 0, i);
        const field *known = known_fields;
        while (known->name && strcmp(known->name, name) != 0) known++;
        if (known->name) {
            double number = scalar(value, name);
            memcpy((char *)&parameters + known->offset, &number, sizeof number);
        } else if (strcmp(name, "young_modulus") == 0) {
            read_material(value, &parameters.material[0].young_modulus, &parameters.material[1].young_modulus);
        } else if (strcmp(name, "poisson_ratio") == 0) {
            read_material(value, &parameters.material[0].poisson_ratio, &parameters.material[1].poisson_ratio);
        } else if (strcmp(name, "displacement_reference") == 0) {
            parameters.displacement_reference = constant(value, name);
        } else {
            mexErrMsgIdAndTxt("microslip:argument", "unknown parameter %s", name);
        }
    }
    return parameters;
}

/* ---- Contacts and elements, as bytes ---- */

static void *bytes(mxArray **array, size_t size)
{
    *array = mxCreateNumericMatrix(size, 1, mxUINT8_CLASS, mxREAL);
    return mxGetData(*array);
}

static const void *object(const mxArray *array, size_t size)
{
    return mxIsUint8(array) && mxGetNumberOfElements(array) == size ? mxGetData(array) : NULL;
}

static void init(int is_element, mxArray **result, int n, const mxArray *const *arguments)
{
    int32_t directions = n > 1 ? constant(arguments[1], "directions is a number") : 1;
    int32_t normal_input = n > 2 ? constant(arguments[2], "normal_input is a number") : MSLIP_INPUT_APPROACH;
    void *memory = bytes(result, is_element ? sizeof(mslip_element) : sizeof(mslip_contact));
    mslip_parameters p = read_parameters(arguments[0]);
    check(is_element ? mslip_element_init(&p, directions, normal_input, memory) : mslip_contact_init(&p, memory));
}

/* Adds a field of an object to a struct. */
#define SET(structure, object, name) \
    (mxAddField(structure, #name), mxSetField(structure, 0, #name, mxCreateDoubleScalar((object)->name)))

static mxArray *fields(const mxArray *array)
{
    mxArray *result = mxCreateStructMatrix(1, 1, 0, NULL);
    const mslip_contact *contact = object(array, sizeof *contact);
    const mslip_element *element = object(array, sizeof *element);
    if (contact) {
        check(mslip_contact_check(contact));
        SET(result, contact, composite_modulus);
        SET(result, contact, half_width);
        SET(result, contact, slip_force);
        SET(result, contact, slip_displacement);
        SET(result, contact, initial_stiffness);
        SET(result, contact, slip_energy);
    } else {
        check(mslip_element_check(element));
        SET(result, element, composite_modulus);
        SET(result, element, friction_coefficient);
        SET(result, element, normal_force);
        SET(result, element, half_width);
        SET(result, element, approach);
        SET(result, element, normal_stiffness);
        SET(result, element, tangential_stiffness);
        SET(result, element, directions);
        SET(result, element, normal_input);
    }
    return result;
}

static mxArray *approach(const mxArray *element, const mxArray *force)
{
    mxArray *result = mxCreateDoubleMatrix(mxGetM(force), mxGetN(force), mxREAL);
    require(mxIsDouble(force) && !mxIsComplex(force), "the normal forces are real");
    check(mslip_normal_approach(object(element, sizeof(mslip_element)), mxGetNumberOfElements(force), mxGetPr(force),
                                mxGetPr(result), NULL, NULL));
    return result;
}

/* ---- Harmonic force ---- */

/* directions is 0 for a contact. */
typedef struct size {
    size_t directions, harmonics, samples, rule, periods;
} size;

/* The workspace of the last call serves the next one if that has the same size. */
static struct {
    size size;
    double *memory;
} workspace;

static void free_workspace(void)
{
    free(workspace.memory);
    workspace.memory = NULL;
}

static double *workspace_for(size s)
{
    int32_t directions = (int32_t)s.directions, rule = (int32_t)s.rule, status;
    size_t length = directions ? mslip_element_workspace_length(directions, s.harmonics, s.samples, rule)
                               : mslip_harmonic_workspace_length(s.harmonics, s.samples, rule);
    if (workspace.memory && memcmp(&workspace.size, &s, sizeof s) == 0) return workspace.memory;
    free_workspace();
    workspace.size = s;
    /* One double for a size that is rejected. */
    workspace.memory = malloc((length ? length : 1) * sizeof(double));
    require(workspace.memory != NULL, "out of memory");
    status = directions
                 ? mslip_element_workspace_init(directions, s.harmonics, s.samples, rule, s.periods, length, workspace.memory)
                 : mslip_harmonic_workspace_init(s.harmonics, s.samples, rule, length, workspace.memory);
    if (status != MSLIP_OK) free_workspace();
    check(status);
    return workspace.memory;
}

static double *output(mxArray **result, size_t rows, size_t columns)
{
    *result = mxCreateDoubleMatrix(rows, columns, mxREAL);
    return mxGetPr(*result);
}

static void harmonic_force(int outputs, mxArray **result, int n, const mxArray *const *arguments)
{
    const mslip_contact *contact = object(arguments[0], sizeof *contact);
    const mslip_element *element = object(arguments[0], sizeof *element);
    size_t samples = count(arguments[1], "the number of samples is a number"), rows = mxGetM(arguments[2]);
    int32_t rule = n > 3 ? constant(arguments[3], "the rule is a number") : MSLIP_UNIFORM_SAMPLING;
    size_t periods = n > 4 ? count(arguments[4], "the number of periods is a number") : 0;
    size_t components = element ? (size_t)element->directions + 1 : 1;
    double *memory, *force, *jacobian, *dissipated, *drift;

    require(n <= 4 || mxGetScalar(arguments[4]) >= 0, "the number of periods is not negative");
    require(contact || element, "the object is neither a contact nor an element");
    require(mxIsDouble(arguments[2]) && !mxIsComplex(arguments[2]) && rows % 2 == 1 && mxGetN(arguments[2]) == components,
            "the displacement has 2H+1 rows, and a column for each component");
    memory = workspace_for((size){ element ? element->directions : 0, rows / 2, samples, rule, periods });
    force = output(&result[0], rows, components);
    jacobian = outputs > 1 ? output(&result[1], rows * components, rows * components) : NULL;
    dissipated = outputs > 2 ? output(&result[2], 1, 1) : NULL;
    drift = outputs > 3 ? output(&result[3], 1, 1) : NULL; /* of a contact it remains 0 */
    check(element ? mslip_element_harmonic_force(element, memory, mxGetPr(arguments[2]), force, jacobian, dissipated, drift)
                  : mslip_harmonic_force(contact, memory, mxGetPr(arguments[2]), force, jacobian, dissipated));
}

void mexFunction(int outputs, mxArray *result[], int n, const mxArray *arguments[])
{
    char command[32];
    require(mslip_abi_version() == MSLIP_ABI_VERSION, "header and library have different interfaces");
    require(n >= 1 && mxIsChar(arguments[0]) && mxGetString(arguments[0], command, sizeof command) == 0,
            "the first argument is a command");
    mexAtExit(free_workspace);
    n--, arguments++;
    if (strcmp(command, "contact") == 0 && n == 1) {
        init(0, result, n, arguments);
    } else if (strcmp(command, "element") == 0 && n >= 1 && n <= 3) {
        init(1, result, n, arguments);
    } else if (strcmp(command, "fields") == 0 && n == 1) {
        result[0] = fields(arguments[0]);
    } else if (strcmp(command, "approach") == 0 && n == 2) {
        result[0] = approach(arguments[0], arguments[1]);
    } else if (strcmp(command, "harmonic_force") == 0 && n >= 3 && n <= 5) {
        harmonic_force(outputs, result, n, arguments);
    } else {
        mexErrMsgIdAndTxt("microslip:argument", "no command %s with %d more arguments", command, n);
    }
}
