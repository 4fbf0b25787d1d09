// SPDX-License-Identifier: GPL-3.0-or-later
// The emitted C of a robot. MODEL_rhs and MODEL_defaults are its functions: -DMODEL_rhs=.. -DMODEL_defaults=..
#include "measure.hpp"

extern "C" {
int MODEL_rhs(double t, const double* x, const double* p, const double* u, const int* mode, double* dx);
void MODEL_defaults(double* x, double* p);
}

namespace {

class Emitted {
 public:
  explicit Emitted(const engines::Arguments& arguments) : n_(arguments.n), dx_(2 * n_), p_(1000), u_(1000) {
    std::vector<double> start(2 * n_);
    MODEL_defaults(start.data(), p_.data());
  }
  void forward(const double* x, double* a) {
    if (MODEL_rhs(0, x, p_.data(), u_.data(), nullptr, dx_.data()) != 0) throw std::runtime_error("a singular state");
    std::copy(dx_.begin() + static_cast<std::ptrdiff_t>(n_), dx_.end(), a);
  }

 private:
  std::size_t n_;
  std::vector<double> dx_, p_, u_;
};

}  // namespace

int main(int argc, char** argv) { return engines::compare<Emitted>(argc, argv); }
