/* The C interface from C: `c_test NAME` runs one test. */
#include <inttypes.h>
#include <lockstone.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

static lks_world* make_world(void) {
  lks_world_def def;
  lks_world* world = NULL;
  OK(lks_world_def_init(&def, sizeof def));
  def.body_capacity = 16;
  def.pair_capacity = 128;
  def.contact_capacity = 64;
  def.joint_capacity = 8;
  OK(lks_world_create(&def, NULL, &world));
  return world;
}

static lks_body add(lks_world* world, uint32_t motion, lks_shape shape, int64_t y_mm) {
  lks_body_def def;
  lks_body body = 0;
  OK(lks_body_def_init(&def, sizeof def));
  def.motion = motion;
  def.shape = shape;
  def.position.y = lks_position_mm(y_mm);
  OK(lks_create_body(world, &def, &body));
  return body;
}

static lks_body add_ball(lks_world* world) {
  return add(world, LKS_DYNAMIC, lks_sphere(lks_length_mm(250)), 10000);
}

static void a_ball_falls_and_rests_on_the_ground(void) {
  lks_world* world = make_world();
  const lks_body ground = add(world, LKS_STATIC, lks_half_space(), 0);
  const lks_body ball = add_ball(world);
  lks_step_report report = {.size = sizeof report};
  lks_pose pose;
  uint32_t touching = 0;
  int i;
  for (i = 0; i < 180; ++i)
    OK(lks_step(world, &report));
  OK(lks_body_pose(world, ball, &pose));
  CHECK(lks_position_to_mm(pose.position.y) == 250);
  OK(lks_touching(world, ball, ground, &touching));
  CHECK(touching == 1);
  CHECK(report.status == LKS_OK && report.asleep_bodies == 1);
  lks_world_destroy(world);
}

static void events_tell_of_the_first_contact(void) {
  lks_world* world = make_world();
  const lks_body ground = add(world, LKS_STATIC, lks_half_space(), 0);
  const lks_body ball = add_ball(world);
  lks_event event = {0};
  size_t count = 0;
  int i;
  for (i = 0; i < 180 && count == 0; ++i) {
    OK(lks_step(world, NULL));
    OK(lks_events(world, &event, 1, &count));
  }
  CHECK(count == 1 && event.kind == LKS_CONTACT_BEGIN);
  CHECK((event.a == ball && event.b == ground) || (event.a == ground && event.b == ball));
  CHECK(lks_velocity_to_mm_s(event.approach_speed) > 10000);
  REFUSED(LKS_BUFFER_TOO_SMALL, lks_events(world, NULL, 0, &count));
  CHECK(count == 1);
  lks_world_destroy(world);
}

static void a_hit_tells_where_and_how_hard(void) {
  lks_world* world = make_world();
  const lks_body ground = add(world, LKS_STATIC, lks_half_space(), 0);
  const lks_body ball = add_ball(world);
  lks_hit_event hit = {0};
  lks_body_contact contact[2];
  lks_joint joint;
  size_t count = 0;
  int i;
  OK(lks_set_events(world, ball, LKS_BODY_CONTACT_EVENTS, 1 << LKS_SPEED_BITS));
  REFUSED(LKS_INVALID_ARGUMENT, lks_set_events(world, ball, 4, 0));
  REFUSED(LKS_INVALID_ARGUMENT, lks_set_events(world, ball, 0, -1));
  for (i = 0; i < 180 && count == 0; ++i) {
    OK(lks_step(world, NULL));
    OK(lks_hit_events(world, &hit, 1, &count));
  }
  CHECK(count == 1 && hit.a == ball && hit.b == ground && hit.was_stopped <= 1);
  CHECK(lks_velocity_to_mm_s(hit.approach_speed) > 10000 && hit.normal_impulse > 0);
  CHECK(hit.normal.y < 0);
  for (i = 0; i < 300; ++i)
    OK(lks_step(world, NULL));
  OK(lks_contacts_of(world, ball, contact, 2, &count));
  CHECK(count == 1 && contact[0].other == ground && contact[0].count == 1);
  CHECK(contact[0].normal_force > 0 && contact[0].points[0].normal_force > 0);
  OK(lks_joints_of(world, ball, &joint, 1, &count));
  CHECK(count == 0);
  lks_world_destroy(world);
}

static void a_joint_holds_its_bodies_together(void) {
  lks_world* world = make_world();
  const lks_body anchor = add(world, LKS_STATIC, lks_box(1 << 20, 1 << 20, 1 << 20), 20000);
  const lks_body ball = add_ball(world);
  lks_joint_def def;
  lks_joint joint = 0;
  lks_joint_view view = {.size = sizeof view};
  size_t count = 0;
  int i;
  OK(lks_joint_def_init(&def, sizeof def, LKS_JOINT_BALL, anchor, ball));
  def.frame_b.position.y = lks_length_mm(10000);
  OK(lks_create_joint(world, &def, &joint));
  for (i = 0; i < 120; ++i)
    OK(lks_step(world, NULL));
  OK(lks_joint_get(world, joint, &view));
  CHECK(view.kind == LKS_JOINT_BALL && view.body_a == anchor && view.body_b == ball);
  CHECK(llabs(lks_length_to_um(view.offset.y)) < 1000);
  OK(lks_joints(world, NULL, 1, &count));
  CHECK(count == 1);
  OK(lks_destroy_joint(world, joint));
  REFUSED(LKS_STALE_HANDLE, lks_joint_get(world, joint, &view));
  lks_world_destroy(world);
}

static void a_snapshot_brings_a_world_back(void) {
  uint32_t kind;
  for (kind = LKS_NATIVE; kind <= LKS_CANONICAL; ++kind) {
    lks_world* world = make_world();
    const lks_body ball = add_ball(world);
    const lks_velocity3 up = {0, lks_velocity_mm_s(3000), 0};
    size_t room = 0;
    size_t bytes = 0;
    uint64_t before = 0;
    uint64_t after = 0;
    void* saved;
    OK(lks_snapshot_bytes_max(world, kind, &room));
    saved = malloc(room);
    OK(lks_save(world, kind, saved, room, &bytes));
    OK(lks_hash(world, &before));
    OK(lks_set_velocity(world, ball, &up));
    OK(lks_step(world, NULL));
    OK(lks_hash(world, &after));
    CHECK(before != after);
    OK(lks_load(world, kind, saved, bytes));
    OK(lks_hash(world, &after));
    CHECK(before == after);
    REFUSED(LKS_BUFFER_TOO_SMALL, lks_save(world, kind, saved, 1, &bytes));
    CHECK(bytes > 1);
    free(saved);
    lks_world_destroy(world);
  }
}

static void a_history_recalls_ticks_that_are_stepped_again(void) {
  lks_world* world = make_world();
  unsigned char saved[4096];
  size_t bytes = 0;
  uint64_t before = 0;
  uint64_t after = 0;
  int i;
  lks_step_report report;
  add_ball(world);
  REFUSED(LKS_INVALID_ARGUMENT, lks_world_keep_history(world, LKS_MAX_HISTORY_TICKS + 1));
  OK(lks_world_keep_history(world, 8));
  OK(lks_save(world, LKS_NATIVE, saved, sizeof saved, &bytes));
  for (i = 0; i < 8; ++i)
    OK(lks_step(world, NULL));
  OK(lks_hash(world, &before));
  OK(lks_load(world, LKS_NATIVE, saved, bytes));
  for (i = 0; i < 8; ++i) {
    report.size = sizeof report;
    OK(lks_step(world, &report));
    CHECK(report.recalled_islands == 1 && report.computed_islands == 0);
  }
  OK(lks_hash(world, &after));
  CHECK(before == after);
  OK(lks_load(world, LKS_NATIVE, saved, bytes));
  OK(lks_world_forget_history(world));
  OK(lks_step(world, &report));
  CHECK(report.recalled_islands == 0 && report.computed_islands == 1);
  lks_world_destroy(world);
}

static void damaged_snapshots_are_refused_and_change_nothing(void) {
  lks_world* world = make_world();
  unsigned char saved[4096];
  size_t bytes = 0;
  size_t i;
  uint64_t before = 0;
  uint64_t after = 0;
  add_ball(world);
  OK(lks_save(world, LKS_CANONICAL, saved, sizeof saved, &bytes));
  OK(lks_hash(world, &before));
  for (i = 0; i < bytes; ++i) {
    saved[i] ^= 0x10;
    CHECK(lks_load(world, LKS_CANONICAL, saved, bytes) != LKS_OK);
    saved[i] ^= 0x10;
    CHECK(lks_load(world, LKS_CANONICAL, saved, i) != LKS_OK);
  }
  OK(lks_hash(world, &after));
  CHECK(before == after);
  lks_world_destroy(world);
}

static void the_difference_of_two_states_is_named(void) {
  lks_world* world = make_world();
  const lks_body ball = add_ball(world);
  unsigned char here[4096];
  unsigned char there[4096];
  char text[256] = "";
  char cut[6] = "";
  size_t here_bytes = 0;
  size_t there_bytes = 0;
  uint32_t differs = 2;
  OK(lks_set_name(world, ball, "ball"));
  OK(lks_save(world, LKS_CANONICAL, here, sizeof here, &here_bytes));
  OK(lks_describe_difference(world, here, here_bytes, here, here_bytes, &differs, text,
                             sizeof text));
  CHECK(differs == 0);
  OK(lks_set_user_data(world, ball, 7));
  OK(lks_save(world, LKS_CANONICAL, there, sizeof there, &there_bytes));
  OK(lks_describe_difference(world, here, here_bytes, there, there_bytes, &differs, text,
                             sizeof text));
  CHECK(differs == 1 && strstr(text, "\"ball\", user_data") != NULL);
  OK(lks_describe_difference(world, here, here_bytes, there, there_bytes, &differs, cut,
                             sizeof cut));
  CHECK(strlen(cut) == 5);
  OK(lks_describe_difference(world, here, 3, there, 0, &differs, text, sizeof text));
  lks_world_destroy(world);
}

static void rays_and_shapes_find_bodies(void) {
  lks_world* world = make_world();
  const lks_body ball = add_ball(world);
  const lks_position3 above = {0, lks_position_mm(20000), 0};
  const lks_position3 at = {0, lks_position_mm(10000), 0};
  const lks_length3 down = {0, lks_length_mm(-20000), 0};
  const lks_pose start = {above, lks_quat_identity()};
  const lks_shape box = lks_box(lks_length_mm(100), lks_length_mm(100), lks_length_mm(100));
  lks_query_filter filter;
  lks_hit hit;
  lks_closest closest;
  lks_body found[4];
  size_t count = 0;
  uint32_t blocked = 0;
  OK(lks_cast_ray(world, &above, &down, NULL, &hit));
  CHECK(hit.body == ball && lks_position_to_mm(hit.point.y) == 10250);
  OK(lks_cast_shape(world, &box, &start, &down, NULL, &hit));
  CHECK(hit.body == ball);
  OK(lks_is_ray_blocked(world, &above, &down, NULL, &blocked));
  CHECK(blocked == 1);
  OK(lks_cast_ray_all(world, &above, &down, NULL, &hit, 1, &count));
  CHECK(count == 1 && hit.body == ball);
  OK(lks_overlap_sphere(world, &at, lks_length_mm(100), NULL, found, 4, &count));
  CHECK(count == 1 && found[0] == ball);
  OK(lks_bodies_in_box(world, &at, &above, NULL, found, 4, &count));
  CHECK(count == 1 && found[0] == ball);
  REFUSED(LKS_INVALID_ARGUMENT, lks_bodies_in_box(world, &above, &at, NULL, found, 4, &count));
  OK(lks_closest_point(world, &above, lks_length_mm(20000), NULL, &closest));
  CHECK(closest.body == ball && lks_length_to_um(closest.distance) == 9750000);
  OK(lks_query_filter_init(&filter, sizeof filter));
  filter.ignore = ball;
  OK(lks_cast_ray(world, &above, &down, &filter, &hit));
  CHECK(hit.body == 0);
  OK(lks_query_filter_init(&filter, sizeof filter));
  filter.listed_count = 1;
  filter.listed[0] = ball;
  OK(lks_cast_ray(world, &above, &down, &filter, &hit));
  CHECK(hit.body == 0);
  filter.only_listed = 1;
  OK(lks_cast_ray(world, &above, &down, &filter, &hit));
  CHECK(hit.body == ball);
  filter.tag_mask = 3;
  filter.tag = 1;
  OK(lks_cast_ray(world, &above, &down, &filter, &hit));
  CHECK(hit.body == 0);
  OK(lks_query_filter_init(&filter, 24)); /* of a program from before tags and lists */
  filter.listed_count = 1;
  filter.listed[0] = ball;
  OK(lks_cast_ray(world, &above, &down, &filter, &hit));
  CHECK(hit.body == ball);
  OK(lks_query_filter_init(&filter, sizeof filter));
  filter.listed_count = LKS_FILTER_BODIES + 1;
  REFUSED(LKS_INVALID_ARGUMENT, lks_cast_ray(world, &above, &down, &filter, &hit));
  lks_world_destroy(world);
}

static void hulls_are_built_from_points(void) {
  lks_assets* assets = NULL;
  lks_world* world = NULL;
  lks_world_def def;
  lks_body_def body_def;
  lks_body body = 0;
  lks_body_view view = {.size = sizeof view};
  lks_length3 corners[8];
  lks_number3 factors = {lks_number_milli(2000), lks_number_milli(500), lks_number_milli(-1000)};
  uint64_t hull = 0, slab = 0, same = 0;
  uint32_t child = 7, triangle = 7;
  int i;
  for (i = 0; i < 8; ++i) {
    corners[i].x = lks_length_mm((i & 1) ? 500 : -500);
    corners[i].y = lks_length_mm((i & 2) ? 500 : -500);
    corners[i].z = lks_length_mm((i & 4) ? 500 : -500);
  }
  OK(lks_assets_create(&assets));
  REFUSED(LKS_INVALID_ARGUMENT, lks_assets_add_hull(assets, corners, 3, 64, &hull));
  REFUSED(LKS_INVALID_ARGUMENT, lks_assets_add_hull(assets, corners, 8, 3, &hull));
  REFUSED(LKS_INVALID_ARGUMENT, lks_assets_add_hull(assets, corners, 100000, 64, &hull));
  REFUSED(LKS_NULL_ARGUMENT, lks_assets_add_hull(assets, NULL, 8, 64, &hull));
  CHECK(lks_assets_add_bytes(assets, "no asset", 8, &hull) != LKS_OK);
  OK(lks_assets_add_hull(assets, corners, 8, 64, &hull));
  OK(lks_assets_add_scaled(assets, hull, &factors, &slab));
  factors.z = 0;
  REFUSED(LKS_INVALID_ARGUMENT, lks_assets_add_scaled(assets, hull, &factors, &same));
  factors.z = lks_number_milli(1100000); /* 550 m: beyond 512 */
  REFUSED(LKS_INVALID_ARGUMENT, lks_assets_add_scaled(assets, hull, &factors, &same));
  factors.x = factors.y = factors.z = lks_number_milli(1000);
  REFUSED(LKS_NOT_FOUND, lks_assets_add_scaled(assets, hull + 1, &factors, &same));
  CHECK(same == 0);
  OK(lks_assets_add_scaled(assets, hull, &factors, &same));
  CHECK(same == hull && slab != hull);
  REFUSED(LKS_NOT_FOUND, lks_assets_find_part(assets, hull, 0, &child, &triangle));
  CHECK(child == 7 && triangle == 7);
  OK(lks_world_def_init(&def, sizeof def));
  OK(lks_world_create(&def, assets, &world));
  lks_assets_destroy(assets);
  OK(lks_body_def_init(&body_def, sizeof body_def));
  body_def.shape = lks_hull(hull);
  OK(lks_create_body(world, &body_def, &body));
  OK(lks_body_get(world, body, &view));
  CHECK(view.shape.kind == LKS_HULL && view.shape.asset == hull);
  CHECK(llabs(view.mass - ((int64_t)1000 << LKS_MASS_BITS)) < 8000); /* 1 m³ of 1000 kg/m³ */
  body_def.shape = lks_hull(slab);
  OK(lks_create_body(world, &body_def, &body));
  OK(lks_body_get(world, body, &view));
  CHECK(llabs(view.mass - ((int64_t)1000 << LKS_MASS_BITS)) < 8000); /* 2 m by 0.5 m by 1 m */
  body_def.shape = lks_hull(hull + 1);
  REFUSED(LKS_NOT_FOUND, lks_create_body(world, &body_def, &body));
  lks_world_destroy(world);
}

static void all_bodies_are_read_at_once(void) {
  lks_world* world = make_world();
  const lks_body first = add_ball(world);
  const lks_body second = add_ball(world);
  const lks_body third = add_ball(world);
  lks_body bodies[3] = {0, 0, 7};
  lks_pose poses[3];
  lks_velocity3 velocities[3];
  lks_pose pose;
  lks_velocity3 velocity;
  size_t count = 0;
  OK(lks_destroy_body(world, second));
  OK(lks_step(world, NULL));
  OK(lks_bodies(world, bodies, poses, velocities, 3, &count));
  CHECK(count == 2 && bodies[0] == first && bodies[1] == third && bodies[2] == 7);
  OK(lks_body_pose(world, third, &pose));
  OK(lks_body_velocity(world, third, &velocity));
  CHECK(memcmp(&pose, &poses[1], sizeof pose) == 0);
  CHECK(memcmp(&velocity, &velocities[1], sizeof velocity) == 0 && velocity.y < 0);
  OK(lks_bodies(world, NULL, NULL, NULL, 3, &count));
  REFUSED(LKS_BUFFER_TOO_SMALL, lks_bodies(world, bodies, NULL, NULL, 1, &count));
  CHECK(count == 2);
  lks_world_destroy(world);
}

static void refusals_say_which_field_is_wrong(void) {
  lks_world* world = make_world();
  lks_body_def def;
  lks_body body = 0;
  OK(lks_body_def_init(&def, sizeof def));
  def.shape = lks_sphere(0);
  REFUSED(LKS_INVALID_ARGUMENT, lks_create_body(world, &def, &body));
  CHECK(strstr(lks_last_error(), "body.shape.radius") != NULL);
  REFUSED(LKS_STALE_HANDLE, lks_wake_body(world, 12345));
  CHECK(strlen(lks_last_error()) > 0);
  CHECK(strcmp(lks_status_name(LKS_STALE_HANDLE), "stale handle") == 0);
  CHECK(strcmp(lks_status_name(LKS_READ_ONLY), "read only") == 0);
  CHECK(strcmp(lks_status_name(-1), "unknown status") == 0);
  lks_world_destroy(world);
}

static void unknown_numbers_are_refused(void) {
  lks_world* world = make_world();
  const lks_body ball = add_ball(world);
  const lks_impulse3 push = {0, 0, 0};
  lks_body_def def;
  lks_joint_def joint_def;
  lks_axis axis;
  lks_body body = 0;
  lks_joint joint = 0;
  uint32_t bad;
  for (bad = 6; bad < 1000; bad += 250) { /* 256 would be 0 in a byte */
    OK(lks_body_def_init(&def, sizeof def));
    def.motion = bad + 250;
    REFUSED(LKS_INVALID_ARGUMENT, lks_create_body(world, &def, &body));
    OK(lks_body_def_init(&def, sizeof def));
    def.shape.kind = bad + 252;
    REFUSED(LKS_INVALID_ARGUMENT, lks_create_body(world, &def, &body));
    OK(lks_body_def_init(&def, sizeof def));
    def.surface.friction_rule = bad + 250;
    REFUSED(LKS_INVALID_ARGUMENT, lks_create_body(world, &def, &body));
    REFUSED(LKS_INVALID_ARGUMENT, lks_apply_impulse(world, ball, &push, bad + 250));
    REFUSED(LKS_INVALID_ARGUMENT,
            lks_joint_def_init(&joint_def, sizeof joint_def, bad + 256, ball, ball));
  }
  OK(lks_body_def_init(&def, sizeof def));
  def.flags |= LKS_BODY_ASLEEP;
  REFUSED(LKS_INVALID_ARGUMENT, lks_create_body(world, &def, &body));
  REFUSED(LKS_INVALID_ARGUMENT, lks_set_axis_locks(world, ball, 64));
  REFUSED(LKS_INVALID_ARGUMENT, lks_set_allow_sleep(world, ball, 2));
  OK(lks_joint_def_init(&joint_def, sizeof joint_def, LKS_JOINT_HINGE, ball, ball));
  REFUSED(LKS_INVALID_ARGUMENT, lks_create_joint(world, &joint_def, &joint));
  axis = joint_def.linear[0];
  axis.reserved = 1;
  REFUSED(LKS_INVALID_ARGUMENT, lks_set_linear_axis(world, joint, 0, &axis));
  REFUSED(LKS_INVALID_ARGUMENT, lks_set_linear_axis(world, joint, 3, &joint_def.linear[0]));
  REFUSED(LKS_STALE_HANDLE, lks_set_angular_axis(world, joint, 0, &joint_def.angular[0]));
  lks_world_destroy(world);
}

static void worlds_out_of_range_are_refused(void) {
  static const uint32_t bad[] = {0, 9, 481, 65536 + 60, UINT32_MAX};
  lks_world_def def;
  lks_world* world = NULL;
  uint64_t hash = 0;
  size_t i;
  for (i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
    OK(lks_world_def_init(&def, sizeof def));
    def.tick_rate = bad[i];
    REFUSED(LKS_INVALID_ARGUMENT, lks_world_create(&def, NULL, &world));
    REFUSED(LKS_INVALID_ARGUMENT, lks_config_hash(&def, NULL, &hash));
    CHECK(strstr(lks_last_error(), "world.tick_rate") != NULL);
  }
  OK(lks_world_def_init(&def, sizeof def));
  def.substeps = 256 + 4;
  REFUSED(LKS_INVALID_ARGUMENT, lks_world_create(&def, NULL, &world));
  OK(lks_world_def_init(&def, sizeof def));
  def.broad_phase = 2;
  REFUSED(LKS_INVALID_ARGUMENT, lks_world_create(&def, NULL, &world));
  CHECK(world == NULL);
  REFUSED(LKS_NOT_FOUND, lks_world_create_scene("no such scene", 1, &world));
}

static void structures_of_another_size_are_refused(void) {
  lks_world* world = make_world();
  const lks_body ball = add_ball(world);
  lks_body_def def;
  lks_body_view view = {0};
  lks_world_def world_def;
  lks_step_report report = {0};
  lks_body body = 0;
  uint64_t tick = 9;
  OK(lks_body_def_init(&def, sizeof def));
  def.size = 0;
  REFUSED(LKS_WRONG_SIZE, lks_create_body(world, &def, &body));
  def.size = sizeof def + 8;
  REFUSED(LKS_WRONG_SIZE, lks_create_body(world, &def, &body));
  def.size = UINT32_MAX;
  REFUSED(LKS_WRONG_SIZE, lks_create_body(world, &def, &body));
  REFUSED(LKS_WRONG_SIZE, lks_body_def_init(&def, sizeof def - 8));
  REFUSED(LKS_WRONG_SIZE, lks_body_get(world, ball, &view));
  REFUSED(LKS_WRONG_SIZE, lks_world_def_init(&world_def, 4));
  REFUSED(LKS_WRONG_SIZE, lks_step(world, &report));
  OK(lks_tick(world, &tick));
  CHECK(tick == 0); /* a step that is refused is not done */
  lks_world_destroy(world);
}

static void destroyed_bodies_are_stale(void) {
  lks_world* world = make_world();
  const lks_body ball = add_ball(world);
  const lks_body other = add_ball(world);
  const lks_pose pose = {{0, 0, 0}, lks_quat_identity()};
  const lks_i64x3 v = {0, 0, 0};
  lks_body_view view = {.size = sizeof view};
  lks_pose read_pose;
  lks_velocity3 read_velocity;
  uint32_t out = 7;
  OK(lks_destroy_body(world, ball));
  REFUSED(LKS_STALE_HANDLE, lks_destroy_body(world, ball));
  REFUSED(LKS_STALE_HANDLE, lks_teleport(world, ball, &pose));
  REFUSED(LKS_STALE_HANDLE, lks_move_kinematic(world, ball, &pose));
  REFUSED(LKS_STALE_HANDLE, lks_set_velocity(world, ball, &v));
  REFUSED(LKS_STALE_HANDLE, lks_set_angular_velocity(world, ball, &v));
  REFUSED(LKS_STALE_HANDLE, lks_apply_force(world, ball, &v, LKS_FRAME_WORLD));
  REFUSED(LKS_STALE_HANDLE, lks_body_get(world, ball, &view));
  REFUSED(LKS_STALE_HANDLE, lks_body_pose(world, ball, &read_pose));
  REFUSED(LKS_STALE_HANDLE, lks_body_velocity(world, ball, &read_velocity));
  REFUSED(LKS_STALE_HANDLE, lks_set_name(world, ball, "gone"));
  REFUSED(LKS_STALE_HANDLE, lks_touching(world, ball, other, &out));
  REFUSED(LKS_STALE_HANDLE, lks_touching(world, other, UINT64_MAX, &out));
  REFUSED(LKS_STALE_HANDLE, lks_wake_body(world, 0));
  CHECK(out == 7);
  OK(lks_body_exists(world, ball, &out));
  CHECK(out == 0);
  CHECK(add_ball(world) != ball); /* the slot's next body has another name */
  lks_world_destroy(world);
}

static void queries_out_of_range_are_refused(void) {
  lks_world* world = make_world();
  const lks_position3 origin = {0, 0, 0};
  const lks_position3 far = {INT64_MAX, 0, INT64_MIN};
  const lks_length3 way = {0, lks_length_mm(512000), 0};
  const lks_length3 long_way = {INT32_MIN, 0, 0};
  const lks_pose pose = {{0, 0, 0}, {0, 0, 0, 0}};
  const lks_pose far_pose = {far, lks_quat_identity()};
  const lks_shape sphere = lks_sphere(lks_length_mm(100));
  const lks_shape none = lks_sphere(0);
  const lks_shape plane = lks_half_space();
  const lks_shape unknown = lks_hull(99);
  lks_query_filter filter;
  lks_hit hit;
  lks_closest closest;
  lks_body body;
  size_t count;
  add_ball(world);
  OK(lks_cast_ray(world, &origin, &way, NULL, &hit));
  REFUSED(LKS_INVALID_ARGUMENT, lks_cast_ray(world, &origin, &long_way, NULL, &hit));
  REFUSED(LKS_INVALID_ARGUMENT, lks_cast_ray(world, &far, &way, NULL, &hit));
  REFUSED(LKS_INVALID_ARGUMENT, lks_cast_shape(world, &sphere, &pose, &long_way, NULL, &hit));
  REFUSED(LKS_INVALID_ARGUMENT, lks_cast_shape(world, &none, &pose, &way, NULL, &hit));
  REFUSED(LKS_INVALID_ARGUMENT, lks_cast_shape(world, &plane, &pose, &way, NULL, &hit));
  REFUSED(LKS_NOT_FOUND, lks_cast_shape(world, &unknown, &pose, &way, NULL, &hit));
  REFUSED(LKS_INVALID_ARGUMENT,
          lks_overlap_shape(world, &sphere, &far_pose, NULL, &body, 1, &count));
  REFUSED(LKS_INVALID_ARGUMENT, lks_overlap_sphere(world, &origin, -1, NULL, &body, 1, &count));
  REFUSED(LKS_INVALID_ARGUMENT, lks_closest_point(world, &origin, -1, NULL, &closest));
  REFUSED(LKS_INVALID_ARGUMENT, lks_closest_point(world, &far, 1, NULL, &closest));
  REFUSED(LKS_INVALID_ARGUMENT, lks_closest_point(world, &origin, INT32_MAX, NULL, &closest));
  OK(lks_query_filter_init(&filter, sizeof filter));
  filter.triggers = 2;
  REFUSED(LKS_INVALID_ARGUMENT, lks_cast_ray(world, &origin, &way, &filter, &hit));
  OK(lks_overlap_shape(world, &sphere, &pose, NULL, NULL, 0, &count));
  CHECK(count == 0);
  lks_world_destroy(world);
}

static void scenes_go_back(void) {
  static unsigned char state[1 << 20];
  lks_world* world = NULL;
  size_t count = 0;
  uint64_t before = 0, hash = 1;
  for (uint32_t kind = LKS_NATIVE; kind <= LKS_CANONICAL; ++kind) {
    OK(lks_world_create_scene("wall", 1, &world));
    for (int tick = 0; tick < 5; ++tick)
      OK(lks_step(world, NULL));
    OK(lks_save(world, kind, state, sizeof state, &count));
    OK(lks_hash(world, &before));
    for (int tick = 0; tick < 5; ++tick)
      OK(lks_step(world, NULL));
    OK(lks_load(world, kind, state, count));
    OK(lks_hash(world, &hash));
    CHECK(hash == before);
    lks_world_destroy(world);
  }
}

static void scenes_take_no_commands(void) {
  lks_world* world = NULL;
  lks_world* rest = make_world();
  lks_body body = 0;
  lks_body_def def;
  size_t count = 0;
  unsigned char bytes[4096];
  const lks_acceleration3 none = {0, 0, 0};
  OK(lks_world_create_scene("stack", 1, &world));
  OK(lks_body_def_init(&def, sizeof def));
  REFUSED(LKS_READ_ONLY, lks_create_body(world, &def, &body));
  REFUSED(LKS_READ_ONLY, lks_set_gravity(world, &none));
  OK(lks_save(rest, LKS_CANONICAL, bytes, sizeof bytes, &count));
  REFUSED(LKS_INCOMPATIBLE, lks_load(world, LKS_CANONICAL, bytes, count));
  REFUSED(LKS_BUFFER_TOO_SMALL, lks_bodies(world, &body, NULL, NULL, 1, &count));
  CHECK(count > 1 && body != 0);
  REFUSED(LKS_READ_ONLY, lks_set_name(world, body, "mine"));
  REFUSED(LKS_BUFFER_TOO_SMALL, lks_save(world, LKS_CANONICAL, bytes, 16, &count));
  lks_world_destroy(world);
  lks_world_destroy(rest);
}

static void threads_change_no_result(void) {
  lks_world* alone = NULL;
  lks_world* shared = NULL;
  uint64_t here = 0;
  uint64_t there = 1;
  int i;
  OK(lks_world_create_scene("pile", 3, &alone));
  OK(lks_world_create_scene("pile", 3, &shared));
  REFUSED(LKS_INVALID_ARGUMENT, lks_world_set_threads(shared, 0));
  REFUSED(LKS_INVALID_ARGUMENT, lks_world_set_threads(shared, 65));
  OK(lks_world_set_threads(shared, 3));
  for (i = 0; i < 60; ++i) {
    if (i == 40) OK(lks_world_set_threads(shared, 1));
    OK(lks_step(alone, NULL));
    OK(lks_step(shared, NULL));
  }
  OK(lks_hash(alone, &here));
  OK(lks_hash(shared, &there));
  CHECK(here == there);
  lks_world_destroy(alone);
  lks_world_destroy(shared);
}

static void numbers_convert_exactly(void) {
  int64_t raw = 0;
  char text[32];
  char small[3];
  lks_quat turn;
  const lks_unit3 y = {0, 5, 0};
  const lks_unit3 none = {0, 0, 0};
  CHECK(lks_position_mm(1500) == (int64_t)3 << 31);
  CHECK(lks_position_mm(-1) == -4294967 && lks_position_mm(1) == 4294967);
  CHECK(lks_position_to_um(lks_position_um(-123456789)) == -123456789);
  CHECK(lks_raw64(INT64_MAX, 1, 32) == INT64_MAX && lks_raw64(INT64_MIN, 1, 0) == INT64_MIN);
  CHECK(lks_raw64(INT64_MIN, 1000, 32) == INT64_MIN);
  CHECK(lks_length_mm(100000000) == INT32_MAX && lks_length_mm(-100000000) == INT32_MIN);
  CHECK(lks_whole(INT64_MIN, 1000, 32) == -2147483648000);
  CHECK(lks_whole(INT64_MIN, 1, 0) == INT64_MIN && lks_whole(INT64_MAX, 1000, 0) == INT64_MAX);
  OK(lks_from_ratio(1, -3, 32, &raw));
  CHECK(raw == -1431655765);
  REFUSED(LKS_INVALID_ARGUMENT, lks_from_ratio(1, 0, 32, &raw));
  REFUSED(LKS_INVALID_ARGUMENT, lks_from_ratio(INT64_MAX, 1, 32, &raw));
  REFUSED(LKS_INVALID_ARGUMENT, lks_from_ratio(1, 1, 63, &raw));
  OK(lks_from_decimal("-9.81", LKS_ACCELERATION_BITS, &raw));
  CHECK(raw == lks_acceleration_mm_s2(-9810));
  OK(lks_to_decimal(raw, LKS_ACCELERATION_BITS, text, sizeof text));
  CHECK(strcmp(text, "-9.81") == 0);
  REFUSED(LKS_BUFFER_TOO_SMALL, lks_to_decimal(raw, LKS_ACCELERATION_BITS, small, sizeof small));
  REFUSED(LKS_INVALID_ARGUMENT, lks_to_decimal(raw, 45, text, sizeof text));
  REFUSED(LKS_MALFORMED, lks_from_decimal("1e3", 32, &raw));
  REFUSED(LKS_INVALID_ARGUMENT, lks_from_decimal("99999999999", 32, &raw));
  OK(lks_quat_from_axis_angle(&y, lks_angle_mdeg(180000), &turn));
  CHECK(turn.y == 1 << 30 && turn.x == 0 && turn.z == 0);
  REFUSED(LKS_INVALID_ARGUMENT, lks_quat_from_axis_angle(&none, 0, &turn));
}

static void logs_that_are_none_are_refused(void) {
  lks_log_report report = {.size = sizeof report};
  REFUSED(LKS_NOT_FOUND, lks_verify_log("/no/such/file.lks", &report));
  CHECK(strstr(lks_last_error(), "/no/such/file.lks") != NULL);
  REFUSED(LKS_IO_ERROR, lks_verify_log("/", &report));
  OK(lks_verify_log_bytes("no log", 6, &report));
  CHECK(report.outcome == LKS_LOG_CORRUPT && strlen(report.line) > 0);
  OK(lks_verify_log_bytes(NULL, 0, &report));
  CHECK(report.outcome == LKS_LOG_CORRUPT);
  report.size = 8;
  REFUSED(LKS_WRONG_SIZE, lks_verify_log_bytes("", 0, &report));
}

#include "c_null_test.h"

struct test {
  const char* name;
  void (*run)(void);
};
#define TEST(name) \
  { #name, name }

static const struct test k_tests[] = {TEST(a_ball_falls_and_rests_on_the_ground),
                                      TEST(events_tell_of_the_first_contact),
                                      TEST(a_hit_tells_where_and_how_hard),
                                      TEST(a_joint_holds_its_bodies_together),
                                      TEST(a_snapshot_brings_a_world_back),
                                      TEST(a_history_recalls_ticks_that_are_stepped_again),
                                      TEST(damaged_snapshots_are_refused_and_change_nothing),
                                      TEST(the_difference_of_two_states_is_named),
                                      TEST(rays_and_shapes_find_bodies),
                                      TEST(hulls_are_built_from_points),
                                      TEST(all_bodies_are_read_at_once),
                                      TEST(refusals_say_which_field_is_wrong),
                                      TEST(unknown_numbers_are_refused),
                                      TEST(worlds_out_of_range_are_refused),
                                      TEST(structures_of_another_size_are_refused),
                                      TEST(destroyed_bodies_are_stale),
                                      TEST(queries_out_of_range_are_refused),
                                      TEST(scenes_go_back),
                                      TEST(scenes_take_no_commands),
                                      TEST(threads_change_no_result),
                                      TEST(numbers_convert_exactly),
                                      TEST(logs_that_are_none_are_refused),
                                      TEST(null_pointers_are_refused)};

int main(int argc, char** argv) {
  size_t i;
  int runs = 0;
  for (i = 0; i < sizeof k_tests / sizeof k_tests[0]; ++i) {
    if (argc > 1 && strcmp(argv[1], k_tests[i].name) != 0) continue;
    ++runs;
    k_tests[i].run();
  }
  if (runs == 0) fprintf(stderr, "no such test\n");
  return runs == 0 || failures > 0;
}
