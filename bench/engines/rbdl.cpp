// SPDX-License-Identifier: GPL-3.0-or-later
// RBDL: ForwardDynamics, the recursion of articulated bodies.
#include <rbdl/addons/urdfreader/urdfreader.h>
#include <rbdl/rbdl.h>

#include "measure.hpp"

namespace {

namespace rbdl = RigidBodyDynamics;

class Rbdl {
 public:
  explicit Rbdl(const engines::Arguments& arguments) : n_(arguments.n), damping_(arguments.damping) {
    if (!rbdl::Addons::URDFReadFromFile(arguments.file.c_str(), &model_, false))
      throw std::runtime_error("RBDL refuses the file");
    if (model_.dof_count != n_ || model_.q_size != n_) throw std::runtime_error("another number of coordinates");
    model_.gravity = rbdl::Math::Vector3d(0, 0, -9.81);
    // Its names are those of links; the file calls the link of a joint by the name of the joint.
    for (const std::string& name : arguments.joints) {
      const unsigned body = model_.GetBodyId(name.c_str());
      if (body >= model_.mJoints.size()) throw std::runtime_error("no joint " + name);
      place_.push_back(model_.mJoints[body].q_index);
    }
    q_ = v_ = tau_ = a_ = rbdl::Math::VectorNd::Zero(static_cast<Eigen::Index>(n_));
  }
  void forward(const double* x, double* a) {
    for (std::size_t i = 0; i < n_; ++i) {
      q_[place_[i]] = x[i];
      v_[place_[i]] = x[n_ + i];
      tau_[place_[i]] = -damping_[i] * x[n_ + i];
    }
    rbdl::ForwardDynamics(model_, q_, v_, tau_, a_);
    for (std::size_t i = 0; i < n_; ++i) a[i] = a_[place_[i]];
  }

 private:
  std::size_t n_;
  std::vector<double> damping_;
  rbdl::Model model_;
  rbdl::Math::VectorNd q_, v_, tau_, a_;
  std::vector<Eigen::Index> place_;
};

}  // namespace

int main(int argc, char** argv) { return engines::compare<Rbdl>(argc, argv); }
