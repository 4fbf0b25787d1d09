// SPDX-License-Identifier: GPL-3.0-or-later
// DART: Skeleton::computeForwardDynamics, the recursion of articulated bodies. Its implicit damping vanishes with the
// time step.
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/DegreeOfFreedom.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/utils/urdf/DartLoader.hpp>

#include "measure.hpp"

namespace {

class Dart {
 public:
  explicit Dart(const engines::Arguments& arguments) : n_(arguments.n), q_(n_), v_(n_) {
    dart::utils::DartLoader loader;
    dart::utils::DartLoader::Options options;
    options.mDefaultRootJointType = dart::utils::DartLoader::RootJointType::FIXED;
    loader.setOptions(options);
    skeleton_ = loader.parseSkeleton(arguments.file);
    if (skeleton_ == nullptr) throw std::runtime_error("DART refuses the file");
    if (skeleton_->getNumDofs() != n_) throw std::runtime_error("another number of coordinates");
    skeleton_->setTimeStep(1e-300);
    for (const std::string& name : arguments.joints) {
      const dart::dynamics::DegreeOfFreedom* joint = skeleton_->getDof(name);
      if (joint == nullptr) throw std::runtime_error("no joint " + name);
      place_.push_back(static_cast<Eigen::Index>(joint->getIndexInSkeleton()));
    }
    skeleton_->setGravity(Eigen::Vector3d(0, 0, -9.81));
  }
  void forward(const double* x, double* a) {
    for (std::size_t i = 0; i < n_; ++i) {
      q_[place_[i]] = x[i];
      v_[place_[i]] = x[n_ + i];
    }
    skeleton_->setPositions(q_);
    skeleton_->setVelocities(v_);
    skeleton_->computeForwardDynamics();
    for (std::size_t i = 0; i < n_; ++i) a[i] = skeleton_->getAcceleration(static_cast<std::size_t>(place_[i]));
  }

 private:
  std::size_t n_;
  Eigen::VectorXd q_, v_;
  dart::dynamics::SkeletonPtr skeleton_;
  std::vector<Eigen::Index> place_;
};

}  // namespace

int main(int argc, char** argv) { return engines::compare<Dart>(argc, argv); }
