#include "tools/bench/accuracy/accuracy.h"

#include <array>

namespace lockstone::bench {
namespace {

// One line a row.
constexpr auto k_rows = std::to_array<AccuracyRow>({
    {1, "free fall, 10 s", 1, measure_free_fall},
    {2, "drift of 1 m/s for 10 s, far away", 1, measure_drift},
    {3, "projectile with damping, 10 s", 1, measure_damping},
    {4, "torque-free box, 60 s: energy", 1, measure_box_energy},
    {5, "torque-free box, 60 s: angular momentum", 1, measure_box_momentum},
    {6, "torque-free box: times of the first flips", 1, measure_box_flips},
    {7, "heavy top on a ball joint, 10 s: precession", 1, measure_top},
    {8, "box stops from 5 m/s", 1, measure_stopping},
    {9, "anisotropy of friction", 1, measure_anisotropy},
    {10, "box on a slope: slip angle and creep", 1, measure_sticking},
    {11, "sphere rolls down 20 degrees", 1, measure_rolling},
    {12, "sphere drops 1 m, e = 0.8: first apex", 1, measure_apex},
    {13, "sphere drops 1 m, e = 1: 20 bounces", 1, measure_bounces},
    {14, "Newton's cradle", 1, measure_cradle},
    {15, "pendulum from 90 degrees, 60 s", 1, measure_pendulum},
    {16, "double pendulum, 5 s", 1, measure_double_pendulum},
    {17, "four-bar linkage with a motor, 20 s", 1, measure_linkage},
    {18, "chain of 10 with 100 : 1 at its end, 20 s", 1, measure_chain},
    {19, "stacks of boxes", 1, measure_stacks},
    {20, "heavy box on a light one", 1, measure_mass_ratios},
    {21, "momentum of 1,000 spheres", 1, measure_momentum},
    {22, "arch, house of cards, dropped block of boxes", 1, measure_standing},
    {23, "fast bodies against thin walls", 100'000, measure_tunnels},
    {24, "rays, shape casts, distances", 1'000'000, measure_queries},
    {25, "mass of hulls and compounds", 20'000, measure_masses},
    {26, "cylinder at 100 rad/s, 60 s: angle", 1, measure_cylinder},
    {27, "Dzhanibekov's body, 2 s", 1, measure_dzhanibekov},
    {28, "rod I = (.1, 2, 2.05), 10 s", 1, measure_rod},
    {29, "thrown sphere slips, then rolls", 1, measure_thrown},
    {30, "box slides under 25 rolling balls", 1, measure_carried_balls},
    {31, "49 elastic spheres dropped 5 m", 1, measure_bouncing_grid},
    {32, "216 spheres dropped: overlap", 1, measure_heap},
    {33, "sphere, e = 0.5, from 5 m: rest and peaks", 1, measure_rest},
    {34, "overhang and tipping", 1, measure_overhang},
    {35, "rod pendulum from 90 degrees, 60 s", 1, measure_rod_pendulum},
    {36, "chain of 20 with a heavy end, 10 s", 1, measure_heavy_chain},
    {37, "elastic spheres without gravity", 1, measure_elastic_cloud},
    {38, "the same scene far away", 1, measure_far_away},
    {39, "bodies that rest in one way only", 1, measure_monostable},
    {40, "car of 1500 kg", 1, measure_vehicle},
    {41, "figures driven by poses", 1, measure_figures},
    {42, "ball of 10 kg on a drag", 1, measure_drags},
    {43, "bead on a circle; ratchet", 1, measure_paths},
    {44, "ball that falls through air, plate in the wind", 1, measure_air},
    {101, "baseline: three Euler methods, 10 min", 1, measure_integrators},
    {102, "baseline: stack of 20 on springs", 1, measure_penalty},
});

}  // namespace

std::span<const AccuracyRow> accuracy_rows() {
  return k_rows;
}

}  // namespace lockstone::bench
