#include "tools/bench/neutral/scene_json.h"

#include <limits>

#include <nlohmann/json.hpp>

namespace lockstone::bench {

using Json = nlohmann::json;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NeutralBody, shape, size, fixed, collides, density, position,
                                   velocity, angular_velocity)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NeutralJoint, a, b, anchor_a, anchor_b)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NeutralKick, time, body, velocity)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NeutralTilt, time, degrees)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NeutralScene, name, description, seconds, gravity, friction,
                                   restitution, record_every, watched, tilt, kicks, bodies, joints)

namespace {

constexpr std::size_t k_state_numbers = 13;

// JSON has no numbers that are none: an engine that lost itself says null.
double number_of(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

BodyState state_of(const Json& json) {
  std::array<double, k_state_numbers> n{};
  for (std::size_t i = 0; i < n.size(); ++i)
    n[i] = number_of(json.at(i));
  return {{n[0], n[1], n[2]}, {n[3], n[4], n[5], n[6]}, {n[7], n[8], n[9]}, {n[10], n[11], n[12]}};
}

Json json_of(const BodyState& s) {
  Json json = Json::array();
  for (const double x : s.position)
    json.push_back(x);
  for (const double x : s.orientation)
    json.push_back(x);
  for (const double x : s.velocity)
    json.push_back(x);
  for (const double x : s.angular_velocity)
    json.push_back(x);
  return json;
}

Played played_of(const Json& json) {
  Played played;
  json.at("engine").get_to(played.engine);
  json.at("scene").get_to(played.scene);
  json.at("setting").get_to(played.setting);
  json.at("cpu_seconds").get_to(played.cpu_seconds);
  played.hash = json.value("hash", std::uint64_t{0});
  played.note = json.value("note", "");
  for (const Json& sample : json.at("samples")) {
    auto& states = played.samples.emplace_back();
    for (const Json& state : sample)
      states.push_back(state_of(state));
  }
  return played;
}

}  // namespace

std::string scenes_to_json(std::span<const NeutralScene> scenes) {
  Json json{{"format", "lockstone scenes 1"}, {"tick_rate", k_scene_tick_rate}};
  json["scenes"] = std::vector<NeutralScene>(scenes.begin(), scenes.end());
  return json.dump(1);
}

std::vector<NeutralScene> scenes_from_json(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.contains("scenes")) return {};
  try {
    return json.at("scenes").get<std::vector<NeutralScene>>();
  } catch (const Json::exception&) {
    return {};
  }
}

std::string played_to_json(const Played& played) {
  Json json{{"engine", played.engine},   {"scene", played.scene},
            {"setting", played.setting}, {"cpu_seconds", played.cpu_seconds},
            {"hash", played.hash},       {"note", played.note}};
  json["samples"] = Json::array();
  for (const auto& sample : played.samples) {
    Json states = Json::array();
    for (const BodyState& state : sample)
      states.push_back(json_of(state));
    json["samples"].push_back(std::move(states));
  }
  return json.dump();
}

bool played_from_json(std::string_view line, Played& played) {
  const Json json = Json::parse(line, nullptr, false);
  if (json.is_discarded()) return false;
  try {
    played = played_of(json);
  } catch (const Json::exception&) {
    return false;
  }
  return true;
}

}  // namespace lockstone::bench
