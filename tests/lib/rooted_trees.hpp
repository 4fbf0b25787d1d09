// Rooted trees, which index the order conditions of one-step methods (Hairer, Norsett, Wanner I, section II.2).
#pragma once

#include <cstddef>
#include <vector>

namespace trees {

/// A rooted tree: its order, its density gamma, and the subtrees of its root.
struct Tree {
  int order;
  double density;
  std::vector<std::size_t> branches;
};

/// Adds all trees of the given order with branches from trees[0..last], largest index first.
inline void grow(std::vector<Tree>& trees, int order, int missing, std::size_t last,
                 std::vector<std::size_t>& branches) {
  if (missing == 0) {
    double density = order;
    for (const std::size_t b : branches) density *= trees[b].density;
    trees.push_back({order, density, branches});
    return;
  }
  for (std::size_t b = 0; b <= last; ++b) {
    if (trees[b].order > missing) continue;
    branches.push_back(b);
    grow(trees, order, missing - trees[b].order, b, branches);
    branches.pop_back();
  }
}

inline std::vector<Tree> rooted_trees(int order) {
  std::vector<Tree> trees{{1, 1, {}}};
  for (int n = 2; n <= order; ++n) {
    std::vector<std::size_t> branches;
    grow(trees, n, n - 1, trees.size() - 1, branches);
  }
  return trees;
}

}  // namespace trees
