/* Vehicles: a dynamic body, the chassis, on sprung wheels that are cast to the ground. Its ahead is
 * x, up y, right z, in the axes of its shape. */
#ifndef LOCKSTONE_C_VEHICLES_H
#define LOCKSTONE_C_VEHICLES_H

#include "bodies.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { LKS_WHEEL_RAY = 0, LKS_WHEEL_SPHERE = 1 };
/* A motorcycle leans into its turns, and an axle of half track 0 has one wheel. The wheels of a
 * side of a tracked vehicle have one radius and turn together; their speeds steer. */
enum { LKS_VEHICLE_CAR = 0, LKS_VEHICLE_MOTORCYCLE = 1, LKS_VEHICLE_TRACKED = 2 };

/* Two wheels. Torques are of each wheel, N·m. */
typedef struct lks_axle {
  lks_length3 mount;        /* between the wheels' centres where they are highest */
  lks_length half_track;    /* from there to a wheel */
  lks_length radius;        /* 5 cm … 4 m */
  lks_length travel;        /* way of a wheel down, 1 cm … 4 m */
  lks_number frequency;     /* Hz, of the mass on a wheel, 0.2 … 10 */
  lks_number damping_ratio; /* 0 … 2 */
  lks_number anti_roll;     /* stiffness over that of a spring, 0 … 4 */
  lks_angle max_steer;      /* ±1.2 rad */
  lks_unit drive;           /* share of the drive's torque, 0 … 1 */
  lks_unit friction;        /* of the tyres, 0 … 1.99 */
  lks_force brake;
  lks_force handbrake;
  lks_force differential_lock; /* the most from the faster wheel to the other */
} lks_axle;

typedef struct lks_vehicle_def {
  uint32_t size;
  uint32_t axle_count; /* 1 … 3 */
  lks_axle axles[3];
  lks_unit peak_slip;          /* where a tyre grips best, along: 0.02 … 1 */
  lks_unit peak_angle;         /* and across, a tangent */
  lks_length relaxation;       /* 0.1 … 4 m */
  lks_unit rolling_resistance; /* 0 … 1 */
  lks_force torque[8];         /* N·m at 0, 1/7 … 7/7 of max_speed */
  lks_angular_velocity idle_speed;
  lks_angular_velocity max_speed;
  lks_inertia engine_inertia;
  lks_force engine_friction; /* N·m at max_speed without throttle */
  lks_number ratios[8];      /* engine over drive shaft; 0 ends the list */
  lks_number reverse;
  lks_number final_drive;
  uint32_t automatic; /* 1: shifts by itself */
  uint32_t shift_ticks;
  lks_angular_velocity shift_up;
  lks_angular_velocity shift_down;
  lks_force clutch; /* N·m */
  lks_inertia wheel_inertia;
  uint32_t cast;
  uint32_t mask; /* categories of the bodies that carry it */
  uint32_t kind;
  lks_angle max_lean; /* of a motorcycle, 0 … 1.2 rad */
} lks_vehicle_def;

typedef struct lks_vehicle_controls {
  uint32_t size;
  int32_t gear;      /* −1: back; 0: none; else the gear, of an automatic gearbox any */
  lks_unit throttle; /* 0 … 1 */
  lks_unit brake;
  lks_unit handbrake;
  lks_unit steer; /* −1 … 1, to the right */
  lks_unit clutch;
  uint32_t reserved;
} lks_vehicle_controls;

typedef struct lks_wheel_view {
  lks_position3 centre;
  lks_angular_velocity spin;
  lks_force load;
  lks_length compression;
  lks_unit steer_sin; /* sine of the angle that it is turned to the right */
  uint32_t is_grounded;
  uint32_t reserved;
} lks_wheel_view;

typedef struct lks_vehicle_view {
  uint32_t size;
  int32_t gear;
  lks_angular_velocity engine_speed;
  uint32_t wheel_count;
  lks_angle lean;           /* of the chassis to the right */
  lks_wheel_view wheels[6]; /* left and right of each axle */
} lks_vehicle_view;

/* Sets the defaults: gear 1, nothing pressed. */
LKS_API lks_status lks_vehicle_controls_init(lks_vehicle_controls* controls, size_t size);
/* A car to begin with: an engine of so much torque, five gears, rear wheels driven, front wheels
 * steered. `length`: between the axles; `height` of their mounts. */
LKS_API lks_status lks_make_car(lks_length length, lks_length half_track, lks_length height,
                                lks_force torque, lks_vehicle_def* out, size_t size);
/* A motorcycle and a tracked vehicle to begin with. */
LKS_API lks_status lks_make_motorcycle(lks_length length, lks_length height, lks_force torque,
                                       lks_vehicle_def* out, size_t size);
LKS_API lks_status lks_make_tank(lks_length length, lks_length half_track, lks_length height,
                                 lks_force torque, lks_vehicle_def* out, size_t size);

/* Makes a dynamic body a chassis, or with null takes its wheels away; at most
 * lks_world_def.vehicle_capacity. */
LKS_API lks_status lks_set_vehicle(lks_world* world, lks_body chassis, const lks_vehicle_def* def);
/* Until the next one. */
LKS_API lks_status lks_drive_vehicle(lks_world* world, lks_body chassis,
                                     const lks_vehicle_controls* controls);
/* `out->size` must be set. Fails for a body that is no chassis. */
LKS_API lks_status lks_vehicle_get(const lks_world* world, lks_body chassis, lks_vehicle_view* out);

#ifdef __cplusplus
}
#endif

#endif
