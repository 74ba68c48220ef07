// All of the mathematics that a game needs for its own rules, in one header. A page shows its use:
// docs/how-to/game-maths.md.
#pragma once

#include <lockstone/fixed.h>
#include <lockstone/literals.h>
#include <lockstone/quat.h>
#include <lockstone/random.h>
#include <lockstone/roots.h>
#include <lockstone/rotation.h>
#include <lockstone/transform.h>
#include <lockstone/trigonometry.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>
#include <lockstone/vector_math.h>
