#include <lockstone/world.h>

int main() {
  return lockstone::World::create({}).ok() ? 0 : 1;
}
