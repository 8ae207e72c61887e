#pragma once

#include <gtest/gtest.h>
#include <tendril/base/types.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

/// Reads binary glTF and moves its mesh, by the letter of the specification and with nothing of the program.
namespace tendril::test {

class GlbReader {
 public:
  using Json = nlohmann::json;

  explicit GlbReader(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(bytes, 4), 2u);
    EXPECT_EQ(word(bytes, 8), bytes.size());
    const std::size_t length = word(bytes, 12);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    EXPECT_EQ(length % 4, 0u);
    json = Json::parse(bytes.substr(20, length));
    EXPECT_EQ(bytes.substr(24 + length, 4), std::string("BIN\0", 4));
    buffer_ = bytes.substr(28 + length, word(bytes, 20 + length));
  }

  Json json;

  /// An accessor's numbers, as they count.
  std::vector<double> numbers(std::size_t index) const {
    const Json& accessor = json.at("accessors").at(index);
    const Json& view = json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    static const std::map<std::string, std::size_t> sizes{
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    const std::size_t count = accessor.at("count").get<std::size_t>() * sizes.at(accessor.at("type"));
    EXPECT_EQ(view.at("byteOffset").get<std::size_t>() % 4, 0u);
    const char* at = buffer_.data() + view.at("byteOffset").get<std::size_t>();
    const int type = accessor.at("componentType");
    std::vector<double> out;
    if (type == 5123) append<std::uint16_t>(at, count, out);
    if (type == 5125) append<std::uint32_t>(at, count, out);
    if (type == 5126) append<float>(at, count, out);
    EXPECT_EQ(out.size(), count) << "component type " << type;
    if (accessor.value("normalized", false))
      for (double& x : out) x /= 65535.0;
    return out;
  }

  std::vector<double> attribute(const std::string& name) const {
    return numbers(primitive().at("attributes").at(name));
  }
  const Json& primitive(std::size_t mesh = 0) const {
    return json.at("meshes").at(mesh).at("primitives").at(0);
  }
  /// A node by its name.
  std::size_t node(const std::string& name) const {
    const Json& nodes = json.at("nodes");
    const auto named = [&](const Json& n) { return n.value("name", "") == name; };
    const auto found = std::find_if(nodes.begin(), nodes.end(), named);
    EXPECT_NE(found, nodes.end()) << name;
    return static_cast<std::size_t>(found - nodes.begin());
  }
  /// Where it is in the world, at a key of the animation.
  Eigen::Affine3d place(const std::string& name, std::size_t moment) const {
    return pose(moment).at(node(name));
  }

  std::size_t moments() const {
    const Json& sampler = json.at("animations").at(0).at("samplers").at(0);
    return json.at("accessors").at(sampler.at("input").get<std::size_t>()).at("count");
  }

  /// The vertices in the world, as the file stores them at rest: none of the animation applied.
  std::vector<Vec3> rest() const { return skinned(pose({})); }
  /// At a key of the animation.
  std::vector<Vec3> at(std::size_t moment) const { return skinned(pose(moment)); }
  /// The same of a mesh with morph targets.
  std::vector<Vec3> morphed(std::size_t moment) const {
    std::vector<Vec3> out = points(attribute("POSITION"));
    const Json& sampler = json.at("animations").at(0).at("samplers").at(0);
    const std::vector<double> weights = numbers(sampler.at("output"));
    const std::size_t targets = primitive().at("targets").size();
    for (std::size_t k = 0; k < targets; ++k) {
      const std::vector<Vec3> moved = points(numbers(primitive().at("targets").at(k).at("POSITION")));
      for (std::size_t i = 0; i < out.size(); ++i) out[i] += weights[moment * targets + k] * moved[i];
    }
    const Eigen::Affine3d place = local(json.at("nodes").at(0));
    for (Vec3& p : out) p = place * p;
    return out;
  }

 private:
  static std::uint32_t word(const std::string& bytes, std::size_t at) {
    std::uint32_t out = 0;
    std::memcpy(&out, bytes.data() + at, 4);
    return out;
  }

  template <class T>
  static void append(const char* at, std::size_t count, std::vector<double>& out) {
    for (std::size_t i = 0; i < count; ++i) {
      T value;
      std::memcpy(&value, at + i * sizeof(T), sizeof(T));
      out.push_back(static_cast<double>(value));
    }
  }

  static std::vector<Vec3> points(const std::vector<double>& numbers) {
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < numbers.size(); i += 3)
      out.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return out;
  }

  static Eigen::Affine3d local(const Json& node) {
    Eigen::Affine3d out = Eigen::Affine3d::Identity();
    const auto numbers = [&](const char* key) { return node.at(key).get<std::vector<double>>(); };
    if (node.contains("translation")) out.translate(Vec3(numbers("translation").data()));
    if (node.contains("rotation")) {
      const auto q = numbers("rotation");
      out.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
    }
    return out;
  }

  /// Every node's place in the world.
  std::vector<Eigen::Affine3d> pose(std::optional<std::size_t> moment) const {
    Json nodes = json.at("nodes");
    if (moment) {
      const Json& animation = json.at("animations").at(0);
      for (const Json& channel : animation.at("channels")) {
        const Json& sampler = animation.at("samplers").at(channel.at("sampler").get<std::size_t>());
        EXPECT_EQ(sampler.at("interpolation"), "LINEAR");
        const std::string path = channel.at("target").at("path");
        const std::vector<double> keys = numbers(sampler.at("output"));
        const auto size = static_cast<std::ptrdiff_t>(path == "rotation" ? 4 : 3);
        const auto from = keys.begin() + size * static_cast<std::ptrdiff_t>(*moment);
        nodes.at(channel.at("target").at("node").get<std::size_t>())[path] =
            std::vector<double>(from, from + size);
      }
    }
    std::vector<Eigen::Affine3d> out(nodes.size());
    const std::function<void(std::size_t, const Eigen::Affine3d&)> visit = [&](std::size_t n,
                                                                               const auto& parent) {
      out[n] = parent * local(nodes[n]);
      for (const std::size_t child : nodes[n].value("children", std::vector<std::size_t>{}))
        visit(child, out[n]);
    };
    for (const std::size_t n : json.at("scenes").at(0).at("nodes")) visit(n, Eigen::Affine3d::Identity());
    return out;
  }

  std::vector<Vec3> skinned(const std::vector<Eigen::Affine3d>& nodes) const {
    const Json& skin = json.at("skins").at(0);
    const std::vector<double> inverse = numbers(skin.at("inverseBindMatrices"));
    std::vector<Eigen::Matrix4d> joints;
    for (const std::size_t n : skin.at("joints"))
      joints.push_back(nodes[n].matrix() *
                       Eigen::Map<const Eigen::Matrix4d>(inverse.data() + 16 * joints.size()));
    const std::vector<double> joint = attribute("JOINTS_0"), weight = attribute("WEIGHTS_0");
    std::vector<Vec3> out = points(attribute("POSITION"));
    for (std::size_t i = 0; i < out.size(); ++i) {
      Eigen::Vector4d sum = Eigen::Vector4d::Zero();
      for (std::size_t k = 4 * i; k < 4 * i + 4; ++k)
        sum += weight[k] * joints.at(static_cast<std::size_t>(joint[k])) * out[i].homogeneous();
      out[i] = sum.head<3>();
    }
    return out;
  }

  std::string buffer_;
};

}  // namespace tendril::test
