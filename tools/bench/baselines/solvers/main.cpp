// Solvers of one set of scenes, compared: see docs/notes/solver-choice.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "tools/bench/baselines/solvers/scenes.h"
#include "tools/bench/baselines/solvers/stepper.h"

namespace lockstone::bench::trial {
namespace {

constexpr double k_still = 0.02;  // m/s

struct Outcome {
  double displacement = 0, gap = 0, gain = 0, last_speed = 0, rest = 0, milliseconds = 0;
  double motor_error = 0;
  Counts counts;
  int ticks = 0;
};

double next_uniform(unsigned long long& state) {
  state = state * 6364136223846793005ull + 1442695040888963407ull;
  return static_cast<double>(state >> 11) * 0x1p-53;
}

double fastest(const System& s) {
  double most = 0;
  for (const Body& b : s.bodies)
    if (!b.fixed()) most = std::max(most, length(b.velocity) + b.radius * length(b.spin));
  return most;
}

double widest_gap(const System& s) {
  double most = 0;
  std::vector<Row> rows;
  for (int i = 0; i < static_cast<int>(s.joints.size()); ++i) {
    rows.clear();
    append_joint_rows(s, i, 1, rows);
    double sum = 0;
    for (const Row& row : rows)
      if (row.kind == RowKind::bilateral && !row.rotational) sum += row.error * row.error;
    most = std::max(most, std::sqrt(sum));
  }
  return most;
}

double motor_error(const Scene& scene) {
  if (scene.motor < 0) return 0;
  const Joint& j = scene.system.joints[scene.motor];
  return std::fabs(scene.system.bodies[j.b].spin.z / j.speed - 1);
}

class Trial {
 public:
  Trial(Scene& scene, const Options& options)
      : scene_(scene), stepper_(scene.system, options), start_(scene.system.bodies) {
    least_ = scene.system.energy();
    for (const Body& b : start_)
      scale_ += b.mass * 9.81 * std::max(std::fabs(b.position.y), b.radius);
  }

  Outcome run() {
    const int ticks = static_cast<int>(scene_.seconds * 60);
    for (tick_ = 0; tick_ < ticks && !failed_; ++tick_) {
      stepper_.tick();
      watch(ticks);
    }
    outcome_.ticks = tick_;
    outcome_.gain /= std::max(scale_, peak_);
    for (std::size_t i = 0; i < start_.size(); ++i)
      outcome_.displacement = std::max(
          outcome_.displacement, length(scene_.system.bodies[i].position - start_[i].position));
    outcome_.counts = stepper_.counts();
    outcome_.milliseconds = 1000 * stepper_.seconds() / tick_;
    return outcome_;
  }

 private:
  void watch(int ticks) {
    const System& s = scene_.system;
    const double energy = s.energy(), speed = fastest(s);
    outcome_.gain = std::max(outcome_.gain, energy - least_);
    least_ = std::min(least_, energy);
    peak_ = std::max(peak_, s.kinetic_energy());
    if (speed > k_still) outcome_.rest = (tick_ + 1) / 60.0;
    if (tick_ >= ticks - 60) outcome_.last_speed = std::max(outcome_.last_speed, speed);
    if (tick_ >= 30) outcome_.gap = std::max(outcome_.gap, widest_gap(s));
    if (tick_ >= 30) outcome_.motor_error = std::max(outcome_.motor_error, motor_error(scene_));
    failed_ = !(speed < 1000);
    if (failed_) outcome_.last_speed = 1e9;
  }

  Scene& scene_;
  Stepper stepper_;
  std::vector<Body> start_;
  Outcome outcome_;
  double least_ = 0, scale_ = 0, peak_ = 0;
  int tick_ = 0;
  bool failed_ = false;
};

const std::map<std::string, double Options::*>& real_settings() {
  static const std::map<std::string, double Options::*> list{
      {"contact-hertz", &Options::contact_hertz},
      {"carry", &Options::carry},
      {"stiffen", &Options::stiffen},
      {"give", &Options::give},
      {"joint-give", &Options::joint_give},
      {"keep", &Options::keep_normal},
      {"soft-leak", &Options::soft_leak},
      {"leak", &Options::leak},
      {"overload", &Options::overload},
      {"keep-tangent", &Options::keep_tangent},
      {"tolerance", &Options::tolerance},
      {"least-gain", &Options::least_gain},
      {"beta", &Options::beta},
      {"push", &Options::push},
      {"least-stiffness", &Options::least_stiffness},
      {"ramp", &Options::ramp},
      {"forget-impulse", &Options::forget_impulse},
      {"forget-stiffness", &Options::forget_stiffness},
      {"contact-damping", &Options::contact_damping},
      {"joint-hertz", &Options::joint_hertz},
  };
  return list;
}

const std::map<std::string, int Options::*>& whole_settings() {
  static const std::map<std::string, int Options::*> list{
      {"substeps", &Options::substeps},
      {"iterations", &Options::iterations},
      {"relaxations", &Options::relaxations},
      {"newton", &Options::newton},
      {"joint-steps", &Options::joint_steps},
      {"first-sweeps", &Options::first_sweeps},
      {"sweeps", &Options::sweeps},
      {"largest", &Options::largest_direct},
      {"round-impulse", &Options::round_impulse},
      {"round-factor", &Options::round_factor},
      {"round-pose", &Options::round_pose},
      {"descents", &Options::descents},
  };
  return list;
}

const std::map<std::string, bool Options::*>& switches() {
  static const std::map<std::string, bool Options::*> list{
      {"reuse", &Options::reuse},         {"half-kick", &Options::half_kick},
      {"geometric", &Options::geometric}, {"scale", &Options::scale_warm_start},
      {"nonlinear", &Options::nonlinear},
  };
  return list;
}

bool set(Options& options, const std::string& name, double value) {
  if (const auto found = real_settings().find(name); found != real_settings().end())
    options.*found->second = value;
  else if (const auto whole = whole_settings().find(name); whole != whole_settings().end())
    options.*whole->second = static_cast<int>(value);
  else if (const auto flag = switches().find(name); flag != switches().end())
    options.*flag->second = value != 0;
  else
    return false;
  return true;
}

struct Request {
  Options options;
  std::string family;
  double size = 0, seconds = 0;
  int first_seed = 1, seeds = 1;
};

bool parse(Request& request, const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) return false;
  const std::string name = text.substr(0, equals);
  const double value = std::atof(text.c_str() + equals + 1);
  if (name == "family")
    request.family = text.substr(equals + 1);
  else if (name == "size")
    request.size = value;
  else if (name == "seconds")
    request.seconds = value;
  else if (name == "seed")
    request.first_seed = static_cast<int>(value);
  else if (name == "seeds")
    request.seeds = static_cast<int>(value);
  else
    return set(request.options, name, value);
  return true;
}

void print(const char* name, double size, int seed, const Outcome& o) {
  std::printf("%-12s %6g %3d  moved %8.2e gap %8.2e gain %8.1e speed %8.1e rest %5.2f ms %7.3f",
              name, size, seed, o.displacement, o.gap, o.gain, o.last_speed, o.rest,
              o.milliseconds);
  if (o.motor_error > 0) std::printf(" motor %7.1e", o.motor_error);
  const double phases = std::max(1L, o.counts.phases);
  if (o.counts.phases > 0)
    std::printf(" direct %.2f factors %.2f open %.3f pivot %.0e blocks %ld",
                o.counts.direct_steps / phases, o.counts.factors / phases,
                o.counts.unconverged / phases, o.counts.greatest_pivot, o.counts.blocks);
  std::printf("\n");
  std::fflush(stdout);
}

void run_family(const Family& family, const Request& request) {
  if (!request.family.empty() && request.family != family.name) return;
  for (const double size : family.sizes) {
    if (request.size != 0 && request.size != size) continue;
    for (int seed = request.first_seed; seed < request.first_seed + request.seeds; ++seed) {
      Random random(seed);
      Scene scene;
      family.make(scene, random, size);
      if (request.seconds > 0) scene.seconds = request.seconds;
      print(family.name, size, seed, Trial(scene, request.options).run());
    }
  }
}

int usage() {
  std::puts("lockstone_solvers soft|proximal|descent [family=F] [size=N] [seeds=N] [NAME=VALUE …]");
  return 2;
}

}  // namespace

double Random::operator()(double low, double high) {
  return low + (high - low) * next_uniform(state_);
}

int run(int count, char** arguments) {
  if (count < 2) return usage();
  Request request;
  const std::string method = arguments[1];
  if (method == "proximal")
    request.options.method = Method::proximal;
  else if (method == "descent")
    request.options.method = Method::descent;
  else if (method != "soft")
    return usage();
  for (int i = 2; i < count; ++i)
    if (!parse(request, arguments[i])) return usage();
  for (const auto* list : {&contact_families(), &joint_families(), &mixed_families()})
    for (const Family& family : *list)
      run_family(family, request);
  return 0;
}

}  // namespace lockstone::bench::trial

int main(int count, char** arguments) {
  return lockstone::bench::trial::run(count, arguments);
}
