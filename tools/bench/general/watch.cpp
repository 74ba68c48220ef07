#include "tools/bench/general/watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/bench/general/vectors.h"
#include "tools/bench/support/measure.h"
#include "tools/render/svg.h"

namespace lockstone::bench {

using namespace general;

namespace {

constexpr double k_still_speed = 0.02, k_still_spin = 0.1;  // m/s, rad/s

double bounded(double x) {
  return std::isfinite(x) ? std::clamp(x, -k_lost_figure, k_lost_figure) : k_lost_figure;
}
void raise(double& worst, double x) {
  worst = std::max(worst, bounded(x));
}

double energy_of(const GeneralBody& body, const GeneralState& state, const Triple& gravity,
                 double low) {
  const Triple spin = turned(inverse(state.orientation), state.angular_velocity);
  const Triple moments = moments_of(body);
  double turning = 0;
  for (std::size_t i = 0; i < 3; ++i)
    turning += 0.5 * moments[i] * spin[i] * spin[i];
  return turning + mass_of(body) * (0.5 * dot(state.velocity, state.velocity) -
                                    dot(gravity, state.position) - norm(gravity) * low);
}

// How far a joint is from holding.
double gap_of(const GeneralJoint& joint, const GeneralState& a, const GeneralState& b) {
  const Triple apart = b.position + turned(b.orientation, joint.anchor_b) - a.position -
                       turned(a.orientation, joint.anchor_a);
  if (joint.link == Link::rod) {
    if (joint.hertz > 0 || joint.limited) return 0;
    return std::abs(norm(apart) - joint.target);
  }
  if (joint.link != Link::slider) return norm(apart);
  const Triple axis = turned(a.orientation * joint.frame_a, {1, 0, 0});
  return norm(apart - dot(apart, axis) * axis);
}

double lowest_point(const GeneralBody& body, const GeneralState& state) {
  const auto rise = [&](const Triple& way) { return turned(state.orientation, way)[1]; };
  const double height = state.position[1];
  if (body.form == Form::sphere) return height - body.size[0];
  if (body.form == Form::capsule)
    return height - std::abs(rise({0, body.size[1], 0})) - body.size[0];
  if (body.form == Form::box)
    return height - std::abs(rise({body.size[0], 0, 0})) - std::abs(rise({0, body.size[1], 0})) -
           std::abs(rise({0, 0, body.size[2]}));
  double low = 0;
  for (const Triple& point : body.points)
    low = std::min(low, rise(point));
  return height + low;
}

double speed_of(const GeneralJoint& joint, const GeneralState& a, const GeneralState& b) {
  return dot(b.angular_velocity - a.angular_velocity,
             turned(a.orientation * joint.frame_a, {1, 0, 0}));
}

class Watch {
 public:
  Watch(const GeneralScene& scene, const GeneralEngine& engine)
      : scene_(scene), engine_(engine), gravity_{0, -scene.gravity, 0} {
    look();
    begin_ = now_;
    seen_.resize(scene.bodies.size());
    lowest_ = first_ = energy();
    judges_energy_ = scene.passive;
    for (const GeneralBody& body : scene.bodies)  // whose moments are not known exactly
      if (body.moves() && (body.form == Form::hull || body.form == Form::compound))
        judges_energy_ = false;
  }

  /// Energy counts from here where something changes.
  void before(int tick) {
    tick_ = tick;
    const auto is_now = [&](const auto& event) { return event.tick == tick; };
    const auto comes_or_goes = [&](const GeneralBody& body) {
      return body.from == tick || body.until == tick;
    };
    for (const GeneralPull& pull : scene_.pulls)
      if (is_now(pull)) gravity_ = pull.gravity;
    if (!std::ranges::any_of(scene_.pulls, is_now) && !std::ranges::any_of(scene_.moves, is_now) &&
        !std::ranges::any_of(scene_.bodies, comes_or_goes))
      return;
    look();
    lowest_ = energy();
    first_ = std::max(first_, lowest_);
  }

  void after(int tick) {
    look();
    see_joints();
    see_bodies(tick);
    see_energy();
    if (scene_.judge == Judge::rate && tick >= 60) see_motor();
    if (scene_.judge == Judge::amplitude && tick * 10 >= scene_.ticks * 8) see_swing();
  }

  [[nodiscard]] GeneralFigures figures() {
    figures_.error = bounded(error());
    double asleep = 0, all = 0;
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      if (!scene_.bodies[i].moves() || !is_there(i)) continue;
      all += 1;
      asleep += engine_.asleep(static_cast<int>(i)) ? 1 : 0;
    }
    figures_.asleep = all > 0 ? asleep / all : 1;
    if (scene_.judge == Judge::awake) figures_.error = 1 - figures_.asleep;
    const bool never_rests = scene_.must_rest && figures_.rest > scene_.ticks / 60.0;
    figures_.failed = figures_.error > scene_.bound || figures_.speed >= k_lost_figure ||
                      never_rests || (judges_energy_ && figures_.gain > k_gain_bound);
    return figures_;
  }

 private:
  void look() {
    now_.resize(scene_.bodies.size());
    for (std::size_t i = 0; i < now_.size(); ++i)
      now_[i] = engine_.state(static_cast<int>(i));
  }

  [[nodiscard]] double energy() const {
    double sum = 0;
    for (std::size_t i = 0; i < now_.size(); ++i)
      if (scene_.bodies[i].moves() && is_there(i))
        sum += energy_of(scene_.bodies[i], now_[i], gravity_, scene_.low);
    return sum;
  }

  [[nodiscard]] bool is_there(std::size_t body) const {
    return scene_.bodies[body].from <= tick_ && tick_ < scene_.bodies[body].until;
  }

  void see_joints() {
    for (const GeneralJoint& joint : scene_.joints)
      if (is_there(static_cast<std::size_t>(joint.a)) &&
          is_there(static_cast<std::size_t>(joint.b)))
        raise(figures_.gap, gap_of(joint, at(joint.a), at(joint.b)));
  }

  void see_bodies(int tick) {
    bool moves = false;
    for (std::size_t i = 0; i < now_.size(); ++i) {
      if (!scene_.bodies[i].moves() || !is_there(i)) continue;
      const double speed = norm(now_[i].velocity), spin = norm(now_[i].angular_velocity);
      raise(figures_.speed, speed);
      moves = moves || !(speed < k_still_speed && spin < k_still_spin);
    }
    if (moves) figures_.rest = (tick + 2) / 60.0;
    for (const int body : scene_.watched) {
      const auto i = static_cast<std::size_t>(body);
      if (!is_there(i)) continue;
      raise(farthest_, norm(now_[i].position - begin_[i].position));
      raise(highest_, now_[i].position[1] - begin_[i].position[1]);
      if (scene_.judge == Judge::sunk)
        raise(deepest_, scene_.low - lowest_point(scene_.bodies[i], now_[i]));
      if (scene_.judge == Judge::entered && engine_.entered(body)) seen_[i] = true;
    }
  }

  void see_energy() {
    if (!judges_energy_ || !(first_ > 0)) return;
    const double now = energy();
    raise(figures_.gain, (now - lowest_) / first_);
    lowest_ = std::min(lowest_, now);
  }

  void see_motor() {
    for (const GeneralJoint& joint : scene_.joints)
      if (joint.effort > 0)
        raise(off_, std::abs(speed_of(joint, at(joint.a), at(joint.b)) / joint.speed - 1));
  }

  void see_swing() {
    const GeneralJoint& spring = scene_.joints.front();
    raise(off_, std::abs(norm(at(spring.b).position - at(spring.a).position) - spring.target));
  }

  [[nodiscard]] const GeneralState& at(int body) const {
    return now_[static_cast<std::size_t>(body)];
  }
  [[nodiscard]] double moved(int body) const {
    return norm(at(body).position - begin_[static_cast<std::size_t>(body)].position);
  }

  template <class Test>
  [[nodiscard]] double share(Test&& test) const {
    const auto count = std::ranges::count_if(scene_.watched, test);
    return static_cast<double>(count) / static_cast<double>(scene_.watched.size());
  }
  template <class Value>
  [[nodiscard]] double most(Value&& value) const {
    double worst = 0;
    for (const int body : scene_.watched)
      raise(worst, value(body));
    return worst;
  }

  [[nodiscard]] static double reach(const Triple& at) {
    return std::max({std::abs(at[0]), std::abs(at[1]), std::abs(at[2])});
  }

  [[nodiscard]] double spring_angle() const {
    double worst = 0;
    for (const GeneralJoint& joint : scene_.joints) {
      const double angle =
          twist(at(joint.a).orientation * joint.frame_a, at(joint.b).orientation * joint.frame_b);
      const double off = std::remainder(angle - joint.target, 2 * std::acos(-1.0));
      raise(worst, std::abs(off) + norm(at(joint.b).angular_velocity));
    }
    return worst;
  }

  // Of all balls with springs.
  [[nodiscard]] double spring_turn() const {
    double worst = 0;
    for (const GeneralJoint& joint : scene_.joints) {
      if (joint.link != Link::ball || joint.hertz == 0) continue;
      const Turn target = at(joint.a).orientation * joint.frame_a * turn_by(joint.turn);
      raise(worst, angle_between(target, at(joint.b).orientation * joint.frame_b) +
                       norm(at(joint.b).angular_velocity - at(joint.a).angular_velocity));
    }
    return worst;
  }

  [[nodiscard]] double error() const {
    switch (scene_.judge) {
      case Judge::displacement:
        return scene_.expected > 0 ? most([&](int body) { return moved(body); }) : farthest_;
      case Judge::gap:
        return figures_.gap;
      case Judge::rate:
        return off_;
      case Judge::angle:
        return spring_angle();
      case Judge::turn:
        return spring_turn();
      case Judge::amplitude:
        return std::abs(1 - off_ / scene_.expected);
      case Judge::energy:
        return std::abs(1 - energy() / first_);
      case Judge::gain:
        return figures_.gain;
      case Judge::missed:
        return share([&](int body) { return !(moved(body) >= scene_.expected); });
      case Judge::entered:
        return share([&](int body) { return !seen_[static_cast<std::size_t>(body)]; });
      case Judge::fallen:
        return most([&](int body) { return scene_.low - at(body).position[1]; });
      case Judge::sunk:
        return deepest_;
      case Judge::fastest:
        return figures_.speed;
      case Judge::bounce:
        return highest_;
      case Judge::slowed:
        return most([&](int body) {
          return 1 -
                 at(body).velocity[0] / scene_.bodies[static_cast<std::size_t>(body)].velocity[0];
        });
      case Judge::outside:
        return most([&](int body) { return reach(at(body).position) - scene_.expected; });
      case Judge::awake:
        break;
    }
    return 0;
  }

  const GeneralScene& scene_;
  const GeneralEngine& engine_;
  std::vector<GeneralState> begin_, now_;
  std::vector<bool> seen_;
  GeneralFigures figures_;
  bool judges_energy_ = false;
  int tick_ = 0;
  Triple gravity_{};
  double first_ = 0, lowest_ = 0, farthest_ = 0, highest_ = 0, deepest_ = 0, off_ = 0;
};

}  // namespace

void begin_tick(GeneralEngine& engine, const GeneralScene& scene,
                std::span<const GeneralChange> changes, int tick) {
  const auto at = static_cast<std::size_t>(tick);
  if (tick > 0 && at < changes.size()) engine.change(changes[at]);
  for (const GeneralMove& move : scene.moves)
    if (move.tick == tick) engine.set_motion(move.body, move.velocity, move.angular_velocity);
  for (const GeneralPull& pull : scene.pulls)
    if (pull.tick == tick) engine.set_gravity(pull.gravity);
}

std::optional<GeneralFigures> play_general(const GeneralMaker& maker, const GeneralScene& scene,
                                           int substeps) {
  const std::unique_ptr<GeneralEngine> engine = maker.make(scene, substeps);
  if (engine == nullptr) return std::nullopt;
  Watch watch(scene, *engine);
  const std::vector<GeneralChange> changes = changes_of(scene);
  std::uint64_t taken = 0;
  std::uint32_t contacts = 0;
  for (int tick = 0; tick < scene.ticks; ++tick) {
    begin_tick(*engine, scene, changes, tick);
    watch.before(tick);
    const std::uint64_t begin = thread_nanoseconds();
    engine->step();
    taken += thread_nanoseconds() - begin;
    watch.after(tick);
    contacts = std::max(contacts, engine->contacts());
  }
  GeneralFigures figures = watch.figures();
  figures.contacts = contacts;
  figures.tick_micros = static_cast<double>(taken) * 1e-3 / scene.ticks;
  figures.hash = engine->hash();
  return figures;
}

std::string draw_general(const GeneralMaker& maker, const GeneralScene& scene, int substeps) {
  constexpr int k_pictures = 6, k_columns = 3;
  const std::unique_ptr<GeneralEngine> engine = maker.make(scene, substeps);
  if (engine == nullptr) return {};
  const std::vector<GeneralChange> changes = changes_of(scene);
  std::vector<std::string> pictures;
  for (int tick = 0; tick <= scene.ticks; ++tick) {
    if (tick * (k_pictures - 1) / scene.ticks == static_cast<int>(pictures.size())) {
      const std::string seconds = std::to_string(tick / 60) + "." + std::to_string(tick % 60 / 6);
      pictures.push_back(
          engine->picture(scene.family + ":" + std::to_string(scene.seed) + ", " + seconds + " s"));
      if (pictures.back().empty()) return {};
    }
    begin_tick(*engine, scene, changes, tick);
    engine->step();
  }
  return render::strip(pictures, render::Picture{}, k_columns);
}

}  // namespace lockstone::bench
