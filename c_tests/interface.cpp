// The header in C++17: vectors as buffers; threads that share contacts compute the bits of one thread.
#include "check.h"

#include "outputs.h"

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <vector>

static_assert(std::is_trivially_copyable<mslip_contact>::value, "contacts may be stored and sent");
static_assert(std::is_standard_layout<mslip_contact>::value, "contacts are plain data");
static_assert(sizeof(mslip_contact) == 2032 && sizeof(mslip_parameters) == 80, "the layout is fixed");
static_assert(std::is_trivially_copyable<mslip_element>::value, "elements may be stored and sent");
static_assert(std::is_standard_layout<mslip_element>::value, "elements are plain data");

namespace {

constexpr std::size_t harmonics = 5;
constexpr std::size_t samples = 128;
constexpr std::size_t coefficients = 2 * harmonics + 1;
constexpr std::size_t steps = 200;
constexpr std::size_t contacts = 64;

void accept(std::int32_t status)
{
    if (status != MSLIP_OK) {
        throw std::runtime_error(mslip_status_text(status));
    }
}

class Workspace {
public:
    Workspace() : values_(mslip_harmonic_workspace_length(harmonics, samples, MSLIP_UNIFORM_SAMPLING))
    {
        accept(mslip_harmonic_workspace_init(harmonics, samples, MSLIP_UNIFORM_SAMPLING, values_.size(), values_.data()));
    }
    double *data() { return values_.data(); }

private:
    std::vector<double> values_;
};

mslip_parameters parameters_of(std::size_t index)
{
    mslip_parameters p;
    mslip_parameters_default(&p);
    p.flat_half_width = 1e-4 * static_cast<double>(index % 4);
    p.edge_radius = 1e-2;
    p.length = 1e-2;
    p.normal_force = 50.0 + static_cast<double>(index);
    p.friction_coefficient = 0.5;
    for (mslip_material &body : p.material) {
        body = {2.1e11, 0.3};
    }
    return p;
}

mslip_contact initialised(std::size_t index)
{
    const mslip_parameters p = parameters_of(index);
    mslip_contact contact;
    accept(mslip_contact_init(&p, &contact));
    return contact;
}

// The results of one contact: harmonic force, Jacobian, path and complex stiffness.
std::vector<double> results_of(const mslip_contact &contact, double *workspace)
{
    const double slip = contact.slip_displacement, amplitude = 0.7 * slip;
    std::vector<double> displacement(coefficients, 0.1 * slip), path(steps), state(mslip_state_length(steps));
    displacement[1] = 1.1 * slip;
    for (std::size_t i = 0; i < steps; ++i) {
        const double t = static_cast<double>(i);
        path[i] = slip * std::sin(0.3 * t) * std::cos(0.011 * t * t);
    }
    std::vector<double> results(coefficients + coefficients * coefficients + 1 + steps + 2);
    double *jacobian = &results[coefficients], *energy = jacobian + coefficients * coefficients, *force = energy + 1;
    accept(mslip_harmonic_force(&contact, workspace, displacement.data(), results.data(), jacobian, energy));
    accept(mslip_state_init(state.size(), state.data()));
    accept(mslip_masing_path(&contact, state.size(), state.data(), steps, path.data(), state.data(), force, nullptr, nullptr));
    accept(mslip_complex_stiffness(&contact, 1, &amplitude, force + steps, force + steps + 1, nullptr, nullptr));
    results.insert(results.end(), state.begin(), state.end());
    return results;
}

std::vector<double> element_workspace(std::int32_t directions)
{
    std::vector<double> values(mslip_element_workspace_length(directions, harmonics, samples, MSLIP_UNIFORM_SAMPLING));
    accept(mslip_element_workspace_init(directions, harmonics, samples, MSLIP_UNIFORM_SAMPLING, 0, values.size(), values.data()));
    return values;
}

// One thread's workspaces of elements with one direction and with two.
struct ElementWorkspaces {
    std::vector<double> values[2] = { element_workspace(1), element_workspace(2) };
};

// The results of an element with the parameters of a contact: path, new state, harmonic force and Jacobian.
std::vector<double> results_of(const mslip_element &element, ElementWorkspaces &workspaces)
{
    constexpr std::size_t pieces = 32;
    const std::size_t m = static_cast<std::size_t>(element.directions) + 1, all = m * coefficients;
    std::vector<double> path(m * steps), state(mslip_element_state_length(element.directions, pieces)),
        displacement(all, 0.02 * element.approach);
    for (std::size_t i = 0; i < steps; ++i) {
        const double t = static_cast<double>(i);
        path[m * i] = element.approach * std::sin(0.3 * t) * std::cos(0.011 * t * t);
        path[m * i + m - 2] += 0.2 * element.approach * std::sin(0.17 * t);
        path[m * i + m - 1] = element.approach * (0.6 + 0.7 * std::cos(0.2 * t)); // opens
    }
    displacement[1] = 0.3 * element.approach;
    displacement[all - coefficients] = 0.5 * element.approach;
    std::vector<double> results((m + m * m + 1) * steps + all + all * all + 1);
    double *tangent = &results[m * steps], *energy = tangent + m * m * steps, *force = energy + steps, *jacobian = force + all;
    accept(mslip_element_state_init(element.directions, state.size(), state.data()));
    accept(mslip_element_path(&element, state.size(), state.data(), steps, path.data(), state.data(), results.data(), tangent,
                              energy));
    accept(mslip_element_harmonic_force(&element, workspaces.values[m - 2].data(), displacement.data(), force, jacobian,
                                        jacobian + all * all, nullptr));
    results.insert(results.end(), state.begin(), state.end());
    return results;
}

bool same_bits(const std::vector<double> &x, const std::vector<double> &y)
{
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
}

void test_threads()
{
    constexpr std::size_t threads = 4;
    std::vector<mslip_contact> shared;
    std::vector<mslip_element> elements(contacts);
    std::vector<std::vector<double>> alone, elements_alone, together(contacts), elements_together(contacts);
    Workspace workspace;
    ElementWorkspaces of_elements;

    for (std::size_t i = 0; i < contacts; ++i) {
        const mslip_parameters p = parameters_of(i);
        shared.push_back(initialised(i));
        alone.push_back(results_of(shared.back(), workspace.data()));
        accept(mslip_element_init(&p, 1 + static_cast<std::int32_t>(i % 2), MSLIP_INPUT_APPROACH, &elements[i]));
        elements_alone.push_back(results_of(elements[i], of_elements));
    }
    std::vector<std::thread> pool;
    for (std::size_t first = 0; first < threads; ++first) {
        pool.emplace_back([&shared, &elements, &together, &elements_together, first] {
            Workspace own;
            ElementWorkspaces own_of_elements;
            for (std::size_t i = first; i < contacts; i += threads) {
                together[i] = results_of(shared[i], own.data());
                elements_together[i] = results_of(elements[i], own_of_elements);
            }
        });
    }
    for (std::thread &thread : pool) {
        thread.join();
    }
    for (std::size_t i = 0; i < contacts; ++i) {
        CHECK(same_bits(alone[i], together[i]));
        CHECK(same_bits(elements_alone[i], elements_together[i]));
    }
}

void test_rejection()
{
    mslip_parameters p;
    mslip_parameters_default(&p);
    mslip_contact contact;
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_BAD_FLAT_HALF_WIDTH);
    CHECK(mslip_contact_init(nullptr, &contact) == MSLIP_NULL_POINTER);
    mslip_element element;
    CHECK(mslip_element_init(&p, 1, MSLIP_INPUT_APPROACH, &element) == MSLIP_BAD_FLAT_HALF_WIDTH);
}

} // namespace

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_threads();
    test_rejection();
    return check_report();
}
