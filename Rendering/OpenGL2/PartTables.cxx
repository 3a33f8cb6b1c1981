// See PartTables.h.
#include "Rendering/OpenGL2/PartTables.h"

#include "Rendering/OpenGL2/GeometryBuffers.h"

#include "Rendering/Core/Shading/ShadingFrame.h"
#include "Rendering/Core/Shading/ShadingLight.h"

#include <glm/gtc/matrix_inverse.hpp>

namespace hrt
{
namespace gl
{
namespace
{

void appendTerms(std::vector<glm::vec4>& table, const PhongTerms& terms)
{
  table.emplace_back(terms.ambientColor, terms.ambient);
  table.emplace_back(terms.diffuseColor, terms.diffuse);
  table.emplace_back(terms.specularColor * terms.specular, terms.specularPower);
}

void appendTextureTransform(std::vector<glm::vec4>& table, const Part& part, std::size_t place)
{
  const Textures& textures = part.material.textures;
  // Without coordinates VTK shows no texture.
  const std::size_t count = part.geometry->textureCoordinates.empty() ? 0 : textures.layers.size();
  table.emplace_back(textures.transformX, static_cast<float>(place));
  table.emplace_back(textures.transformY, static_cast<float>(count));
  table.emplace_back(textures.transformW, 0.0f);
}

// `texturePlace`: of the descriptions of the part's textures.
void appendPart(std::vector<glm::vec4>& table, const Part& part,
  const glm::dmat4& shadingFromWorld, std::size_t texturePlace)
{
  const glm::dmat4 toShading = shadingFromWorld * bufferToWorld(part);
  const glm::dmat3 normals = glm::inverseTranspose(glm::dmat3(toShading));
  // The last row is that of every affine matrix.
  const glm::dmat4 rows = glm::transpose(toShading);
  for (int row = 0; row < 3; ++row)
  {
    table.emplace_back(rows[row]);
  }
  // A common factor does not change a direction; without it the matrix of a part that is scaled far
  // from unit size could leave the range of float.
  const double scale = 1.0 / glm::length(normals[0]);
  for (int column = 0; column < 3; ++column)
  {
    table.emplace_back(glm::vec3(normals[column] * scale), 0.0f);
  }
  appendTerms(table, part.material.front);
  appendTerms(table, part.material.back);
  table.emplace_back(part.material.lit ? 1.0f : 0.0f, part.isFlat() ? 0.0f : 1.0f,
    part.material.textures.onBack ? 1.0f : 0.0f, part.material.textures.transformed ? 1.0f : 0.0f);
  appendTextureTransform(table, part, texturePlace);
  const EdgeStyle& edges = part.material.edges;
  table.emplace_back(edges.color, edges.opacity);
  table.emplace_back(edges.width,
    part.material.cullFront || part.material.cullBack ? 1.0f : 0.0f, edges.tubes ? 1.0f : 0.0f,
    0.0f);
  const PhysicalTerms& physical = part.material.physical;
  table.emplace_back(physical.edgeTint, physical.roughness);
  table.emplace_back(physical.coatColor, physical.coat);
  table.emplace_back(physical.used ? physical.metallic : -1.0f, physical.f0,
    physical.coatRoughness, physical.coatF0);
}

void appendLight(std::vector<glm::vec4>& table, const Light& light, bool singleHeadlight,
  const ShadingFrame& frame, const ShadowSlot& shadow)
{
  const shading::HrtLight l = 
    shadingLight(light, singleHeadlight, frame.fromWorld, frame.scale);
  table.emplace_back(l.position, static_cast<float>(l.kind));
  table.emplace_back(l.direction, l.cosCone);
  table.emplace_back(l.color, l.exponent);
  table.emplace_back(l.attenuation, 0.0f);
  table.emplace_back(
    static_cast<float>(shadow.firstFace), static_cast<float>(shadow.faceCount), 0.0f, 0.0f);
}

} // namespace

//------------------------------------------------------------------------------
PartTables::PartTables(ObjectPool& pool)
  : Parts(pool, GL_RGBA32F)
  , Lights(pool, GL_RGBA32F)
{
}

//------------------------------------------------------------------------------
void PartTables::updateParts(const Snapshot& snapshot, const TextureBuffers& textures)
{
  const ShadingFrame frame(snapshot);
  std::vector<glm::vec4> table, descriptions;
  table.reserve(snapshot.parts.size() * kPartTexels);
  for (const Part& part : snapshot.parts)
  {
    appendPart(table, part, frame.fromWorld,
      snapshot.parts.size() * kPartTexels + descriptions.size());
    textures.describe(part, descriptions);
  }
  table.insert(table.end(), descriptions.begin(), descriptions.end());
  this->Parts.upload(table.data(), table.size() * sizeof(table[0]), GL_STREAM_DRAW);
}

//------------------------------------------------------------------------------
void PartTables::updateLights(const Snapshot& snapshot, const std::vector<ShadowSlot>& shadows)
{
  const ShadingFrame frame(snapshot);
  std::vector<glm::vec4> lights;
  lights.reserve(snapshot.lights.size() * kLightTexels);
  for (std::size_t i = 0; i < snapshot.lights.size(); ++i)
  {
    appendLight(
      lights, snapshot.lights[i], snapshot.singleHeadlight, frame, shadows[i]);
  }
  this->Lights.upload(lights.data(), lights.size() * sizeof(lights[0]), GL_STREAM_DRAW);
}

//------------------------------------------------------------------------------
void PartTables::bindTables(int firstUnit) const
{
  this->Parts.bind(firstUnit);
  this->Lights.bind(firstUnit + 1);
}

} // namespace gl
} // namespace hrt
