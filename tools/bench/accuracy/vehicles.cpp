// Row 40: a car of 1500 kg against the formulas of its motion, with the curves of its tyres; the
// lean of a motorcycle, and the radius of a tracked vehicle.
#include <algorithm>
#include <utility>

#include <lockstone/vehicle.h>

#include "tools/bench/accuracy/contact_scene.h"

namespace lockstone::bench {
namespace {

using namespace literals;

constexpr double k_car_mass = 1500, k_wheelbase = 2.5, k_wheel = 0.33, k_bounce = 1.5;
constexpr double k_along = 1.65, k_across = 1.3;  // C of the tyres' curves
constexpr Unit k_all = Unit::from_integer(1);
// Of the springs at rest, and of the centre of mass above the road then.
constexpr double k_sag =
    k_gravity / (4 * std::numbers::pi * std::numbers::pi * k_bounce * k_bounce);
constexpr double k_height = k_wheel + 0.25 + 0.1 - k_sag;

// sin(C·atan(B·x)), 1 at x = 1.
double tyre(double c, double x) {
  return std::sin(c * std::atan(std::tan(std::numbers::pi / 2 / c) * x));
}

// The slip, over that of the best grip, at which the tyre has a share of it below 1.
double slip_for(double c, double share) {
  return std::tan(std::asin(share) / c) / std::tan(std::numbers::pi / 2 / c);
}

class Car {
 public:
  explicit Car(const Setting& setting, double slope = 0) : scene_(setting, world()) {
    BodyDef road;
    road.motion = MotionType::static_body;
    road.shape = Shape::half_space();
    road.material.friction = 1_r;
    road.orientation = from_axis_angle({{}, {}, k_all}, fixed<Angle>(slope));
    scene_.add(road);
    def_ = make_car(fixed<Length>(k_wheelbase), 0.75_m, -0.1_m, Torque::from_integer(350));
    def_.tyre.rolling_resistance = {};
    for (Axle& axle : axles())
      axle.anti_roll = {}, axle.differential_lock = {};
    body_ = body_at(Shape::box(2.1_m, 0.35_m, 0.85_m), -std::sin(slope) * 0.65,
                    std::cos(slope) * 0.65, 0);
    body_.mass.mass = Mass::from_integer(1500);
    body_.orientation = road.orientation;
  }

  [[nodiscard]] std::span<Axle> axles() { return std::span(def_.axles).first(2); }
  [[nodiscard]] VehicleDef& def() { return def_; }
  [[nodiscard]] BodyDef& chassis() { return body_; }
  [[nodiscard]] SceneRun& scene() { return scene_; }
  [[nodiscard]] BodyHandle body() const { return car_; }

  void put(double height = 0.75) {
    if (body_.orientation == Quat{}) body_.position.y = fixed<Position>(height);
    car_ = scene_.add(body_);
    (void)scene_.world().apply(SetVehicle{car_, def_});
    drive({.gear = 0});
  }
  void drive(const VehicleControls& controls) {
    (void)scene_.world().apply(DriveVehicle{car_, controls});
  }
  // At rest on its springs, then at a speed, with the wheels turning.
  void roll(double speed, double height = 0.75) {
    put(height);
    scene_.run(3);
    (void)scene_.world().apply(SetVelocity{car_, fixed<Velocity>(speed, 0, 0)});
    scene_.run(0.5);
  }
  [[nodiscard]] fuzz::Real3 place() { return fuzz::real(scene_.world().position(car_)); }
  [[nodiscard]] double speed() {
    const fuzz::Real3 v = fuzz::real(scene_.world().velocity(car_));
    return std::hypot(v.x, v.z);
  }
  [[nodiscard]] double lean() { return fuzz::real(vehicle_of(scene_.world(), car_)->lean); }
  [[nodiscard]] double turning() {
    return std::abs(fuzz::real(scene_.world().body(car_).angular_velocity.y));
  }

 private:
  [[nodiscard]] static WorldDef world() {
    WorldDef def = contact_world();
    def.vehicle_capacity = 1;
    return def;
  }

  SceneRun scene_;
  VehicleDef def_;
  BodyDef body_;
  BodyHandle car_;
};

// Brakes that hold each wheel at 90 % of its grip, the shift of the load counted: v²/(2·0.9·g).
AccuracyResult braking(const Setting& setting) {
  Car car(setting);
  const double moved = 0.9 * k_height / k_wheelbase;
  for (std::size_t i = 0; i < 2; ++i) {
    const double load = k_car_mass * k_gravity * (0.5 + (i == 0 ? moved : -moved)) / 2;
    car.axles()[i].brake = fixed<Torque>(0.9 * load * k_wheel);
  }
  car.roll(30);
  const int ticks = setting.tick_rate;
  for (int i = 1; i <= ticks; ++i) {
    car.drive({.brake = Unit::from_ratio(i, ticks), .gear = 0});
    car.scene().step();
  }
  const double v = car.speed(), from = car.place().x;
  car.scene().run(5);
  const double way = car.place().x - from;
  return car.scene().result("braking distance", "relative",
                            std::abs(way / (v * v / (2 * 0.9 * k_gravity)) - 1), 0.03);
}

// Locked wheels slip at ten times the best slip; the table of the curve ends at eight.
AccuracyResult locked(const Setting& setting) {
  Car car(setting);
  for (Axle& axle : car.axles())
    axle.brake = Torque::from_integer(20'000);
  car.roll(30);
  car.drive({.brake = k_all, .gear = 0});
  car.scene().run(0.5);
  const double v = car.speed();
  car.scene().run(1);
  const double expected = k_gravity * tyre(k_along, 8);
  return car.scene().result("slide with locked wheels", "relative",
                            std::abs((v - car.speed()) / expected - 1), 0.003);
}

// Ackermann: L / tan δ at the middle of the rear axle.
AccuracyResult slow_turn(const Setting& setting) {
  Car car(setting);
  car.roll(2);
  car.drive({.steer = Unit::from_ratio(1, 2), .gear = 0});
  car.scene().run(1);
  const double radius = std::sqrt(std::pow(car.speed() / car.turning(), 2) - 1.25 * 1.25);
  const double steer = fuzz::real(car.def().axles[0].max_steer) / 2;
  return car.scene().result("radius of a slow turn", "relative",
                            std::abs(radius * std::tan(steer) / k_wheelbase - 1), 0.02);
}

// δ = L/R + α_front − α_rear, with the slip angles that the acceleration takes; tyres of `front` of
// the grip of the rear ones push ahead. The worst part of δ that is wrong.
AccuracyResult cornering(const Setting& setting, double front, const char* name, double goal) {
  Car car(setting);
  car.axles()[0].friction = fixed<Coefficient>(front * front);  // of both surfaces: the root
  car.roll(20);
  car.drive({.steer = Unit::from_ratio(1, 20), .gear = 0});
  car.scene().run(3);
  const double v = car.speed(), turning = car.turning();
  const double share = v * turning / k_gravity, peak = fuzz::real(car.def().tyre.peak_angle);
  const double ahead = std::atan(peak * slip_for(k_across, share / front));
  const double behind = std::atan(peak * slip_for(k_across, share));
  const double steer = fuzz::real(car.def().axles[0].max_steer) / 20;
  const double expected = std::atan(k_wheelbase * turning / v) + ahead - behind;
  return car.scene().result(name, "relative", std::abs(steer / expected - 1), goal);
}

// Of the chassis on four springs: 1 / (f·√(1 − ζ²)).
AccuracyResult bounce(const Setting& setting, double damping, const char* name, double goal) {
  Car car(setting);
  for (Axle& axle : car.axles())
    axle.damping_ratio = fixed<Number>(damping);
  car.put(0.62);
  double before = 0.62 - k_height, first = 0, last = 0;
  int crossings = 0;
  for (int tick = 1; crossings < 4 && tick < 5 * setting.tick_rate; ++tick) {
    car.scene().step();
    const double now = car.place().y - k_height;
    if (before < 0 && now >= 0) {
      last = (tick - now / (now - before)) / setting.tick_rate;
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  const double expected = 1 / (k_bounce * std::sqrt(1 - damping * damping));
  return car.scene().result(name, "relative", std::abs((last - first) / 3 / expected - 1), goal);
}

AccuracyResult parked(const Setting& setting) {
  Car car(setting, 30 * k_degree);
  car.put();
  car.drive({.brake = k_all, .handbrake = k_all, .gear = 0});
  car.scene().run(10);
  const fuzz::Real3 from = car.place();
  car.scene().run(60);
  return car.scene().result("creep in 60 s on 30 degrees", "m", fuzz::norm(car.place() - from),
                            1e-3);
}

// tan φ = v²/(g·r), r of the centre of mass; it coasts.
AccuracyResult leaning(const Setting& setting) {
  Car car(setting);
  car.chassis().shape = Shape::box(0.7_m, 0.5_m, 0.12_m);
  car.chassis().mass.mass = Mass::from_integer(250);
  car.def() = make_motorcycle(1.5_m, -0.25_m, Torque::from_integer(60));
  car.def().tyre.rolling_resistance = {};
  car.roll(12, 0.65);
  car.drive({.steer = Unit::from_ratio(8, 100), .gear = 0});
  car.scene().run(3);
  const double expected = std::atan(car.speed() * car.turning() / k_gravity);
  return car.scene().result("lean of a motorcycle, 12 m/s", "relative",
                            std::abs(std::abs(car.lean()) / expected - 1), 0.01);
}

// b/2·(l + r)/(l − r) with the speeds 1 and 0.8 of the sides; on short tracks, which slip little.
AccuracyResult tracks(const Setting& setting) {
  Car car(setting);
  car.chassis().shape = Shape::box(2_m, 0.4_m, 1_m);
  car.chassis().mass.mass = Mass::from_integer(12'000);
  car.def() = make_tank(0.6_m, 1.2_m, -0.2_m, Torque::from_integer(1500));
  car.put(0.9);
  car.drive({.throttle = Unit::from_ratio(3, 10)});
  car.scene().run(3);
  car.drive({.throttle = Unit::from_ratio(3, 10), .steer = Unit::from_ratio(1, 10)});
  car.scene().run(5);
  return car.scene().result("radius on short tracks", "relative",
                            std::abs(car.speed() / car.turning() / (1.2 * 1.8 / 0.2) - 1), 0.04);
}

}  // namespace

std::vector<AccuracyResult> measure_vehicle(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results;
  const auto add = [&](const std::function<AccuracyResult(const Setting&)>& measure) {
    const std::vector<AccuracyResult> more =
        options.sweep ? over_tick_rates(measure) : std::vector{measure(k_usual_setting)};
    results.insert(results.end(), more.begin(), more.end());
  };
  add(braking);
  add(locked);
  add(slow_turn);
  add([](const Setting& s) { return cornering(s, 1, "steering, balanced, 20 m/s", 0.01); });
  add([](const Setting& s) { return cornering(s, 0.8, "steering, understeer, 20 m/s", 0.02); });
  add([](const Setting& s) { return bounce(s, 0, "period of the suspension", 0.005); });
  add([](const Setting& s) { return bounce(s, 0.2, "the same, damping ratio 0.2", 0.02); });
  add(parked);
  add(leaning);
  add(tracks);
  return results;
}

}  // namespace lockstone::bench
