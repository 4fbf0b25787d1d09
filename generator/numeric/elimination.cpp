// SPDX-License-Identifier: GPL-3.0-or-later
#include "numeric/elimination.hpp"

namespace eomgen::numeric {

template class Elimination<double>;
template class Elimination<cln::cl_R>;
template class Elimination<cln::cl_RA>;

}  // namespace eomgen::numeric
