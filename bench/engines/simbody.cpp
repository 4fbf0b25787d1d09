// SPDX-License-Identifier: GPL-3.0-or-later
// Simbody: realize(Stage::Acceleration), a recursion of order n. It reads no URDF: the file has a line for each link,
// NAME TYPE PARENT  place x 3  axes x 9 (rows)  axis x 3  mass  centre x 3  moments and products about the origin x 6.
#include <Simbody.h>

#include <fstream>

#include "measure.hpp"

namespace {

using SimTK::Vec3;

class Simbody {
 public:
  explicit Simbody(const engines::Arguments& arguments)
      : matter_(system_), forces_(system_), gravity_(forces_, matter_, Vec3(0, 0, -9.81)) {
    std::ifstream file(arguments.file);
    std::string name, type;
    std::vector<std::string> names;
    for (int parent = 0; file >> name >> type >> parent;) {
      std::vector<double> v(25);
      for (double& value : v) file >> value;
      if (!file) throw std::runtime_error("the file has an incomplete line");
      const SimTK::Rotation axes(SimTK::Mat33(v[3], v[4], v[5], v[6], v[7], v[8], v[9], v[10], v[11]), true);
      const SimTK::Body::Rigid body(SimTK::MassProperties(v[15], Vec3(v[16], v[17], v[18]),
                                                          SimTK::Inertia(v[19], v[20], v[21], v[22], v[23], v[24])));
      // A pin turns about the z axis of its frames, a slider moves along x.
      const bool is_pin = type == "pin";
      const SimTK::CoordinateAxis own =
          is_pin ? SimTK::CoordinateAxis(SimTK::ZAxis) : SimTK::CoordinateAxis(SimTK::XAxis);
      const SimTK::Rotation to_axis(SimTK::UnitVec3(v[12], v[13], v[14]), own);
      const SimTK::Transform before(axes * to_axis, Vec3(v[0], v[1], v[2])), after(to_axis, Vec3(0));
      SimTK::MobilizedBody& inner =
          parent < 0 ? matter_.updGround() : matter_.updMobilizedBody(links_.at(static_cast<std::size_t>(parent)));
      if (is_pin)
        links_.push_back(SimTK::MobilizedBody::Pin(inner, before, body, after).getMobilizedBodyIndex());
      else
        links_.push_back(SimTK::MobilizedBody::Slider(inner, before, body, after).getMobilizedBodyIndex());
      names.push_back(name);
    }
    if (names.size() != arguments.n) throw std::runtime_error("another number of coordinates");
    for (std::size_t i = 0; i < arguments.n; ++i) {
      const auto found = std::find(names.begin(), names.end(), arguments.joints[i]);
      if (found == names.end()) throw std::runtime_error("no joint " + arguments.joints[i]);
      place_.push_back(static_cast<std::size_t>(found - names.begin()));
      if (arguments.damping[i] != 0)
        SimTK::Force::MobilityLinearDamper(forces_, matter_.updMobilizedBody(links_[place_[i]]),
                                           SimTK::MobilizerUIndex(0), arguments.damping[i]);
    }
    state_ = system_.realizeTopology();
    system_.realizeModel(state_);
    for (std::size_t& place : place_)
      place = static_cast<std::size_t>(matter_.getMobilizedBody(links_[place]).getFirstUIndex(state_));
  }
  void forward(const double* x, double* a) {
    SimTK::Vector &q = state_.updQ(), &u = state_.updU();
    for (std::size_t i = 0; i < place_.size(); ++i) {
      q[static_cast<int>(place_[i])] = x[i];
      u[static_cast<int>(place_[i])] = x[place_.size() + i];
    }
    system_.realize(state_, SimTK::Stage::Acceleration);
    const SimTK::Vector& rates = state_.getUDot();
    for (std::size_t i = 0; i < place_.size(); ++i) a[i] = rates[static_cast<int>(place_[i])];
  }

 private:
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::Force::UniformGravity gravity_;
  std::vector<SimTK::MobilizedBodyIndex> links_;
  std::vector<std::size_t> place_;
  SimTK::State state_;
};

}  // namespace

int main(int argc, char** argv) { return engines::compare<Simbody>(argc, argv); }
