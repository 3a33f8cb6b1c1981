// Evaluates an AFF scene at a moment: pure functions of the scene and the time, so that a test can
// compare them with matrices composed by hand.
#include "IO/BART/AFF/Scene.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>

namespace hrt
{
namespace bart
{

std::size_t countTriangles(const Mesh& mesh)
{
  // A polygon of n corners gives n - 2, hence the sum over all polygons.
  return mesh.faceEnds.empty() ? mesh.corners.size() / 3
                               : mesh.corners.size() - 2 * mesh.faceEnds.size();
}

TriangleCount countTriangles(const Scene& scene)
{
  TriangleCount count;
  for (const Instance& instance : scene.instances)
  {
    const std::size_t index = static_cast<std::size_t>(instance.index);
    if (instance.shape == Instance::Shape::Mesh)
    {
      const Mesh& mesh = scene.meshes[index];
      count.all += countTriangles(mesh);
      count.textured += mesh.texture == kNone ? 0 : countTriangles(mesh);
    }
    else if (instance.shape == Instance::Shape::AnimatedTriangles)
    {
      count.all += scene.animatedTriangles[index].size();
    }
  }
  return count;
}

glm::dmat4 composeMatrix(
  const glm::dvec3& translation, const glm::dquat& rotation, const glm::dvec3& scale)
{
  glm::dmat4 matrix = glm::mat4_cast(rotation);
  matrix[0] *= scale.x;
  matrix[1] *= scale.y;
  matrix[2] *= scale.z;
  matrix[3] = glm::dvec4(translation, 1.0);
  return matrix;
}

glm::dmat4 matrixAt(const Animation& animation, double time)
{
  return composeMatrix(animation.translation ? animation.translation->at(time) : glm::dvec3(0.0),
    animation.rotation ? animation.rotation->at(time) : glm::dquat(1.0, 0.0, 0.0, 0.0),
    animation.scale ? animation.scale->at(time) : glm::dvec3(1.0));
}

Pose poseAt(const Scene& scene, double time)
{
  Pose pose;
  pose.toWorld.reserve(scene.nodes.size());
  pose.visible.reserve(scene.nodes.size());
  for (const Node& node : scene.nodes)
  {
    glm::dmat4 matrix = node.matrix;
    bool visible = true;
    if (node.animation != kNone)
    {
      const Animation& animation = scene.animations[static_cast<std::size_t>(node.animation)];
      matrix = matrixAt(animation, time);
      visible = !animation.visibility || animation.visibility->at(time);
    }
    if (node.parent != kNone)
    {
      const std::size_t parent = static_cast<std::size_t>(node.parent);
      matrix = pose.toWorld[parent] * matrix;
      visible = visible && pose.visible[parent];
    }
    pose.toWorld.push_back(matrix);
    pose.visible.push_back(visible);
  }
  return pose;
}

glm::dvec3 lightPositionAt(
  const Scene& scene, const Pose& pose, const PointLight& light, double time)
{
  glm::dvec3 position = light.position;
  if (light.animation != kNone)
  {
    const Animation& animation = scene.animations[static_cast<std::size_t>(light.animation)];
    position = animation.translation ? animation.translation->at(time) : position;
  }
  return light.node == kNone
    ? position
    : glm::dvec3(pose.toWorld[static_cast<std::size_t>(light.node)] * glm::dvec4(position, 1.0));
}

Viewpoint viewpointAt(const Scene& scene, double time)
{
  Viewpoint view = scene.viewpoint.value_or(Viewpoint());
  if (scene.camera == kNone)
  {
    return view;
  }
  const Animation& animation = scene.animations[static_cast<std::size_t>(scene.camera)];
  glm::dvec3 forward = view.at - view.from;
  if (animation.rotation)
  {
    // As far away as the viewpoint said, for programs that turn around the focal point.
    const glm::dquat rotation = animation.rotation->at(time);
    forward = rotation * glm::dvec3(0.0, 0.0, -glm::length(forward));
    view.up = rotation * glm::dvec3(0.0, 1.0, 0.0);
  }
  if (animation.translation)
  {
    view.from = animation.translation->at(time);
  }
  view.at = view.from + forward;
  return view;
}

AnimatedTriangle::Corners cornersAt(const AnimatedTriangle& triangle, double time)
{
  const std::vector<double>& times = triangle.times;
  const std::size_t next =
    static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (next == 0 || next == times.size())
  {
    return next == 0 ? triangle.corners.front() : triangle.corners.back();
  }
  // times[next - 1] <= time < times[next]
  const float u = static_cast<float>((time - times[next - 1]) / (times[next] - times[next - 1]));
  AnimatedTriangle::Corners corners;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const AnimatedTriangle::Corners &a = triangle.corners[next - 1], &b = triangle.corners[next];
    corners.positions[i] = glm::mix(a.positions[i], b.positions[i], u);
    corners.normals[i] = glm::mix(a.normals[i], b.normals[i], u);
  }
  return corners;
}

} // namespace bart
} // namespace hrt
