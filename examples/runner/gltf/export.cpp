#include "gltf/export.h"

#include "draw/solid.h"
#include "gltf/surface.h"

#include <tendril/bind/distortion.h>

#include <cmath>

namespace tendril::runner {
namespace {

using Json = Glb::Json;

void append(std::vector<float>& to, const Vec3& v) {
  for (int k = 0; k < 3; ++k) to.push_back(static_cast<float>(v[k]));
}

Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json json_of(const Eigen::Quaterniond& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}

Json list(Json only) {
  Json out = Json::array();
  out.push_back(std::move(only));
  return out;
}

Vec3 middle_of(Points points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return 0.5 * (low + high);
}

/// One file being made.
class Maker {
 public:
  Maker(const Film& film, const bind::PolygonMesh& look, const GltfOptions& options)
      : film_(film), options_(options), surface_(make_surface(look)), middle_(middle_of(film.mesh().points)) {
    const auto up = Eigen::Quaterniond::FromTwoVectors(film.file().view.up, Vec3::UnitY());
    place_ = {{"translation", json_of(Vec3(up * middle_))}};
    if (up.vec().norm() > 0.0) place_["rotation"] = json_of(up);
  }

  GltfFile make() {
    glb_.json["asset"] = {{"version", "2.0"}, {"generator", "tendril"}};
    glb_.json["scene"] = 0;
    add_mesh();
    std::vector<float> times;
    for (const Moment& m : film_.moments())
      times.push_back(static_cast<float>(m.time - film_.moments().front().time));
    times_ = glb_.add(times, "SCALAR", 1, Glb::none, true);
    const Json notes = options_.morph ? add_morph() : add_skin();
    add_solids();
    if (!channels_.empty())
      glb_.json["animations"] = list({{"name", "run"}, {"samplers", samplers_}, {"channels", channels_}});
    glb_.json["asset"]["extras"] = {{"tendril", notes}};
    return {glb_.bytes(), notes};
  }

 private:
  Json& primitive() { return glb_.json["meshes"][0]["primitives"][0]; }

  void add_mesh() {
    std::vector<Vec3> points;
    for (const std::uint32_t i : surface_.point) points.push_back(film_.mesh().points[i] - middle_);
    glb_.json["meshes"] = list(mesh_of(options_.name, surface_, points, 0));
    add_material();
  }

  /// A mesh of the file.
  /// \param points  of the vertices
  Json mesh_of(const std::string& name, const Surface& surface, const std::vector<Vec3>& points,
               std::size_t material) {
    std::vector<float> positions, normals, texture;
    for (const Vec3& p : points) append(positions, p);
    for (const Vec3f& n : surface.normals) append(normals, n.cast<double>());
    for (const auto& t : surface.texture) texture.insert(texture.end(), t.begin(), t.end());
    Json attributes{{"POSITION", glb_.add(positions, "VEC3", 3, Glb::vertices, true)}};
    if (!normals.empty()) attributes["NORMAL"] = glb_.add(normals, "VEC3", 3, Glb::vertices);
    if (!surface.colors.empty()) attributes["COLOR_0"] = add_colors(surface);
    if (!texture.empty()) attributes["TEXCOORD_0"] = glb_.add(texture, "VEC2", 2, Glb::vertices);
    Json primitive{{"attributes", attributes}, {"material", material}};
    if (surface.triangles.empty())
      primitive["mode"] = 0;  // points
    else
      primitive["indices"] = glb_.add(surface.triangles, "SCALAR", 1, Glb::indices);
    return {{"name", name}, {"primitives", list(primitive)}};
  }

  std::size_t add_colors(const Surface& surface) {
    std::vector<std::uint16_t> colors;
    for (const auto& color : surface.colors)
      for (const float part : color)
        colors.push_back(static_cast<std::uint16_t>(std::lround(part * 65535.0F)));
    return glb_.add(colors, "VEC4", 4, Glb::vertices, false, true);
  }

  void add_material() {
    const bool plain = surface_.colors.empty();
    const bool sheer = std::any_of(surface_.colors.begin(), surface_.colors.end(),
                                   [](const auto& color) { return color[3] < 1.0F; });
    Json pbr{{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}};
    if (plain) pbr["baseColorFactor"] = {0.434, 0.356, 0.287, 1.0};  // as pictures have it
    Json material{{"pbrMetallicRoughness", pbr}, {"doubleSided", true}};
    if (sheer) material["alphaMode"] = "BLEND";
    glb_.json["materials"] = list(material);
  }

  void channel(std::size_t node, const char* path, std::size_t output) {
    channels_.push_back({{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers_.push_back({{"input", times_}, {"interpolation", "LINEAR"}, {"output", output}});
  }

  /// Moves a node by a rigid motion of each moment.
  void animate(std::size_t node, const std::vector<scene::SolidPose>& motions) {
    std::vector<float> translation, rotation;
    Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
    for (const scene::SolidPose& motion : motions) {
      append(translation, motion.position - middle_);
      Eigen::Quaterniond q = Eigen::Quaterniond(motion.rotation).normalized();
      if (q.dot(last) < 0.0) q.coeffs() = -q.coeffs();  // the short way round
      last = q;
      for (int c = 0; c < 4; ++c) rotation.push_back(static_cast<float>(q.coeffs()[c]));
    }
    channel(node, "translation", glb_.add(translation, "VEC3", 3));
    channel(node, "rotation", glb_.add(rotation, "VEC4", 4));
  }

  /// The scene's solids, a mesh and a node each, below one node that turns the scene's up as the mesh's does.
  void add_solids() {
    const std::vector<scene::SceneBody>& bodies = film_.file().bodies;
    if (bodies.empty()) return;
    Json& nodes = glb_.json["nodes"];
    Json all = place_;
    all["name"] = "solids";
    const std::size_t above = nodes.size();
    glb_.json["scenes"][0]["nodes"].push_back(above);
    nodes.push_back(all);
    glb_.json["materials"].push_back(
        {{"pbrMetallicRoughness",
          {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}, {"baseColorFactor", {0.61, 0.52, 0.35, 1.0}}}},
         {"doubleSided", true}});
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      nodes[above]["children"].push_back(nodes.size());
      add_solid_node(bodies[i].name, bodies[i].shape, i);
    }
  }

  void add_solid_node(const std::string& name, const scene::SolidShape& shape, std::size_t body) {
    std::vector<scene::SolidPose> motions;
    for (const Moment& m : film_.moments()) motions.push_back(m.bodies[body]);
    const scene::SolidPose& first = motions.front();
    bind::PolygonMesh mesh;
    add_solid(shape, first, middle_, bind::bounding_diagonal(film_.mesh().points), mesh);
    for (Vec3& p : mesh.points) p = first.rotation.transpose() * (p - first.position);
    mesh.point_colors.clear();
    const Surface surface = make_surface(mesh);
    std::vector<Vec3> points;
    for (const std::uint32_t i : surface.point) points.push_back(mesh.points[i]);
    Json& meshes = glb_.json["meshes"];
    const std::size_t node = glb_.json["nodes"].size();
    glb_.json["nodes"].push_back({{"name", name},
                                  {"mesh", meshes.size()},
                                  {"translation", json_of(Vec3(first.position - middle_))},
                                  {"rotation", json_of(Eigen::Quaterniond(first.rotation).normalized())}});
    meshes.push_back(mesh_of(name, surface, points, 1));
    const auto is_first = [&](const scene::SolidPose& m) {
      return m.position == first.position && m.rotation == first.rotation;
    };
    if (!std::all_of(motions.begin(), motions.end(), is_first)) animate(node, motions);
  }

  Json add_skin() {
    const Skin skin = fit_skin(film_, options_.skin);
    std::vector<std::uint16_t> joints;
    std::vector<float> weights;
    for (const std::uint32_t i : surface_.point) add_influences(skin.influences[i], joints, weights);
    Json& attributes = primitive()["attributes"];
    attributes["JOINTS_0"] = glb_.add(joints, "VEC4", 4, Glb::vertices);
    attributes["WEIGHTS_0"] = glb_.add(weights, "VEC4", 4, Glb::vertices);
    const Json notes{{"kind", "skin"},
                     {"joints", skin.joints.size()},
                     {"max_error", skin.error},
                     {"tolerance", options_.skin.tolerance},
                     {"within_tolerance", skin.reached},
                     {"max_joints", options_.skin.max_joints},
                     {"relative_to", bind::bounding_diagonal(film_.mesh().points)}};
    add_joints(skin, notes);
    return notes;
  }

  static void add_influences(const Influences& influences, std::vector<std::uint16_t>& joints,
                             std::vector<float>& weights) {
    float sum = 0.0F;
    for (const double w : influences.weight) sum += static_cast<float>(w);
    for (std::size_t k = 0; k < 4; ++k) {
      joints.push_back(influences.joint[k]);
      weights.push_back(static_cast<float>(influences.weight[k]) / sum);
    }
  }

  void add_joints(const Skin& skin, const Json& notes) {
    constexpr std::size_t kFirst = 2;  // nodes: the mesh, the root of the joints, the joints
    glb_.json["nodes"] = list({{"name", options_.name}, {"mesh", 0}, {"skin", 0}});
    glb_.json["nodes"].push_back(place_);
    glb_.json["nodes"][1]["name"] = "joints";
    glb_.json["scenes"] = list({{"nodes", std::vector<int>{0, 1}}});
    std::vector<float> inverse;
    std::vector<std::size_t> nodes;
    for (const SkinJoint& joint : skin.joints) {
      const Vec3 at = motion_of(joint, film_.rest(), film_.rest()).from - middle_;
      const bool still = joint.pair == SkinJoint::kStill;
      const std::string name =
          still ? "still"
                : film_.file().names[film_.file().bound_to[joint.pair]] + "_" + std::to_string(nodes.size());
      nodes.push_back(kFirst + nodes.size());
      glb_.json["nodes"].push_back(
          {{"name", name}, {"translation", json_of(still ? Vec3(Vec3::Zero()) : at)}});
      const Vec3 back = still ? Vec3(Vec3::Zero()) : Vec3(-at);
      for (const float x : {1.F, 0.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 0.F, 1.F, 0.F}) inverse.push_back(x);
      append(inverse, back);
      inverse.push_back(1.0F);
    }
    glb_.json["nodes"][1]["children"] = nodes;
    glb_.json["skins"] = list({{"inverseBindMatrices", glb_.add(inverse, "MAT4", 16)},
                               {"skeleton", 1},
                               {"joints", nodes},
                               {"extras", {{"tendril", notes}}}});
    animate_joints(skin, kFirst);
  }

  void animate_joints(const Skin& skin, std::size_t first_node) {
    std::vector<std::vector<CurvePair>> posed;
    for (std::size_t m = 0; m < film_.moments().size(); ++m) posed.push_back(film_.posed(m));
    for (std::size_t k = 0; k < skin.joints.size(); ++k) {
      if (skin.joints[k].pair == SkinJoint::kStill) continue;
      std::vector<scene::SolidPose> motions;
      for (const auto& pose : posed) {
        const JointMotion motion = motion_of(skin.joints[k], film_.rest(), pose);
        motions.push_back({motion.rotation, motion.to});
      }
      animate(first_node + k, motions);
    }
  }

  /// The drawn triangles at rest, with the normals of their vertices, so that these can be turned.
  bind::PolygonMesh drawn() const {
    bind::PolygonMesh out;
    for (const std::uint32_t i : surface_.point) out.points.push_back(film_.mesh().points[i]);
    for (const Vec3f& n : surface_.normals) out.point_normals.push_back(n.cast<double>());
    out.corners = surface_.triangles;
    for (std::size_t end = 3; end <= out.corners.size(); end += 3)
      out.face_begin.push_back(static_cast<std::uint32_t>(end));
    return out;
  }

  Json add_target(const bind::PolygonMesh& rest, std::size_t moment) {
    const std::vector<Vec3> all = film_.points(moment);
    std::vector<Vec3> points;
    for (const std::uint32_t i : surface_.point) points.push_back(all[i]);
    std::vector<float> moved, turned;
    for (std::size_t i = 0; i < points.size(); ++i) append(moved, points[i] - rest.points[i]);
    Json target{{"POSITION", glb_.add(moved, "VEC3", 3, Glb::vertices, true)}};
    if (rest.point_normals.empty()) return target;
    const std::vector<Vec3> normals = bind::posed_normals(rest, points);
    for (std::size_t i = 0; i < normals.size(); ++i) append(turned, normals[i] - rest.point_normals[i]);
    target["NORMAL"] = glb_.add(turned, "VEC3", 3, Glb::vertices);
    return target;
  }

  Json add_morph() {
    const std::size_t count = film_.moments().size();
    const bind::PolygonMesh rest = drawn();
    Json targets = Json::array();
    for (std::size_t m = 0; m < count; ++m) targets.push_back(add_target(rest, m));
    primitive()["targets"] = targets;
    glb_.json["meshes"][0]["weights"] = std::vector<float>(count, 0.0F);
    Json node = place_;
    node["name"] = options_.name;
    node["mesh"] = 0;
    glb_.json["nodes"] = list(node);
    glb_.json["scenes"] = list({{"nodes", std::vector<int>{0}}});
    std::vector<float> weights(count * count, 0.0F);
    for (std::size_t m = 0; m < count; ++m) weights[m * count + m] = 1.0F;
    channel(0, "weights", glb_.add(weights, "SCALAR", 1));
    return {{"kind", "morph targets"}, {"targets", count}};
  }

  const Film& film_;
  const GltfOptions& options_;
  Surface surface_;
  Vec3 middle_;
  Json place_;  ///< the node that takes the mesh's middle to where it is
  Glb glb_;
  std::size_t times_ = 0;
  Json samplers_ = Json::array(), channels_ = Json::array();  ///< of the one animation
};

}  // namespace

GltfFile make_gltf(const Film& film, const bind::PolygonMesh& look, const GltfOptions& options) {
  return Maker(film, look, options).make();
}

}  // namespace tendril::runner
