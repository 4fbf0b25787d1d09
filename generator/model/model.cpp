// SPDX-License-Identifier: GPL-3.0-or-later
// The functions that every user of a Model needs. The oracle links no other file of this stage.
#include "model/model.hpp"

namespace eomgen::model {

Scene::Scene() = default;
Scene::Scene(const Scene&) = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene&) = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

Model::Model() = default;
Model::Model(const Model&) = default;
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(const Model&) = default;
Model& Model::operator=(Model&&) noexcept = default;
Model::~Model() = default;

NodeId Force::acceleration() const {
  return effects.size() == 1 && effects[0].load_type == Effect::LoadType::acceleration ? effects[0].value : no_node;
}

}  // namespace eomgen::model
