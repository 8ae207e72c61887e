#include <tendril/contact/rod_contact.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <iostream>

using namespace tendril;

int main() {
  const std::vector<Vec3> p{Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(1, 0, 0)};
  Scene scene;
  scene.rods = {
      make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {1e6, 4e5, 1000.0}, circular_section(0.02))};
  contact::Collider floor{"floor", contact::half_space(), {}};
  floor.placement.position = Vec3(0, 0, -0.1);
  scene.forces = {std::make_shared<Gravity>(Vec3(0, 0, -9.81)),
                  std::make_shared<contact::RodContact>(std::vector<contact::ContactRod>{{0, 0.02, p}},
                                                        std::vector{floor}, contact::Law{.stiffness = 1e5})};
  const System system(scene);
  Simulation simulation(system, system.rest_state());
  if (simulation.run(0.3).stop != Stop::finished) return 1;
  if (!(simulation.state().y[2] > -0.1)) return 2;
  std::cout << "contact works\n";
}
