// The header in C++17: memory by vectors, and threads that share contacts and give the bits of one thread.
#include "check.h"

#include <microslip.h>

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <vector>

static_assert(std::is_trivially_copyable<mslip_contact>::value, "contacts may be stored and sent");
static_assert(std::is_standard_layout<mslip_contact>::value, "contacts are plain data");
static_assert(sizeof(mslip_contact) == 1992 && sizeof(mslip_parameters) == 80, "the layout is fixed");

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
    Workspace() : numbers_(mslip_harmonic_workspace_length(harmonics, samples))
    {
        accept(mslip_harmonic_workspace_init(harmonics, samples, numbers_.size(), numbers_.data()));
    }
    double *data() { return numbers_.data(); }

private:
    std::vector<double> numbers_;
};

mslip_contact prepare(std::size_t index)
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
    mslip_contact contact;
    accept(mslip_contact_init(&p, &contact));
    return contact;
}

// What one contact answers, by every function that has memory of its own.
struct Answer {
    std::vector<double> harmonic, jacobian, force, state, stiffness;
    double dissipated = 0.0;

    bool operator==(const Answer &other) const
    {
        auto same = [](const std::vector<double> &x, const std::vector<double> &y) {
            return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
        };
        return same(harmonic, other.harmonic) && same(jacobian, other.jacobian) && same(force, other.force)
            && same(state, other.state) && same(stiffness, other.stiffness) && dissipated == other.dissipated;
    }
};

Answer ask(const mslip_contact &contact, double *workspace)
{
    Answer answer;
    std::vector<double> displacement(coefficients, 0.1 * contact.slip_displacement);
    displacement[1] = 1.1 * contact.slip_displacement;
    answer.harmonic.resize(coefficients);
    answer.jacobian.resize(coefficients * coefficients);
    accept(mslip_harmonic_force(&contact, workspace, displacement.data(), answer.harmonic.data(),
                                answer.jacobian.data(), &answer.dissipated));

    std::vector<double> path(steps);
    for (std::size_t i = 0; i < steps; ++i) {
        const double t = static_cast<double>(i);
        path[i] = contact.slip_displacement * std::sin(0.3 * t) * std::cos(0.011 * t * t);
    }
    answer.state.resize(mslip_state_length(steps));
    answer.force.resize(steps);
    accept(mslip_state_init(answer.state.size(), answer.state.data()));
    accept(mslip_masing_path(&contact, answer.state.size(), answer.state.data(), steps, path.data(),
                             answer.state.data(), answer.force.data(), nullptr, nullptr));

    answer.stiffness.resize(2);
    const double amplitude = 0.7 * contact.slip_displacement;
    accept(mslip_complex_stiffness(&contact, 1, &amplitude, &answer.stiffness[0], &answer.stiffness[1], nullptr,
                                   nullptr));
    return answer;
}

void test_threads()
{
    constexpr std::size_t threads = 4;
    std::vector<mslip_contact> shared;
    std::vector<Answer> alone, together(contacts);
    Workspace workspace;

    for (std::size_t i = 0; i < contacts; ++i) {
        shared.push_back(prepare(i));
        alone.push_back(ask(shared.back(), workspace.data()));
    }
    std::vector<std::thread> pool;
    for (std::size_t first = 0; first < threads; ++first) {
        pool.emplace_back([&shared, &together, first] {
            Workspace own;
            for (std::size_t i = first; i < contacts; i += threads) {
                together[i] = ask(shared[i], own.data());
            }
        });
    }
    for (std::thread &thread : pool) {
        thread.join();
    }
    for (std::size_t i = 0; i < contacts; ++i) {
        CHECK(alone[i] == together[i]);
        CHECK(std::abs(alone[i].force.back()) <= shared[i].slip_force);
    }
}

// A copy of the bytes is the contact.
void test_copy()
{
    const mslip_contact contact = prepare(3);
    std::vector<unsigned char> bytes(sizeof contact);
    mslip_contact copy;
    Workspace workspace;
    std::memcpy(bytes.data(), &contact, sizeof contact);
    std::memcpy(&copy, bytes.data(), sizeof copy);
    CHECK(ask(contact, workspace.data()) == ask(copy, workspace.data()));
}

void test_refusal()
{
    mslip_parameters p;
    mslip_parameters_default(&p);
    mslip_contact contact;
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_BAD_FLAT_HALF_WIDTH);
    CHECK(mslip_contact_init(nullptr, &contact) == MSLIP_NULL_POINTER);
}

} // namespace

int main(int argc, char **argv)
{
    check_arguments(argc, argv);
    test_threads();
    test_copy();
    test_refusal();
    return check_report();
}
