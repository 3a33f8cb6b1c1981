// See GeometryBuffers.h.
#include "Rendering/OpenGL2/GeometryBuffers.h"

#include "Rendering/OpenGL2/PartTables.h"

#include <algorithm>

namespace hrt
{
namespace gl
{
namespace
{

constexpr std::size_t kCornerBytes = sizeof(glm::vec4);

// Corners a chunk while they are widened for upload: 1 MiB.
constexpr std::size_t kChunk = 1 << 16;

// Uploads a float table of corners: three components would need OpenGL 4.0, so a fourth is added, in
// chunks rather than in a copy of the whole mesh.
std::size_t uploadPadded(
  TextureBuffer& table, std::size_t first, const std::vector<glm::vec3>& values, float w)
{
  std::vector<glm::vec4> texels;
  for (std::size_t start = 0; start < values.size(); start += kChunk)
  {
    texels.clear();
    for (std::size_t i = start; i < std::min(start + kChunk, values.size()); ++i)
    {
      texels.emplace_back(values[i], w);
    }
    table.uploadRange((first + start) * kCornerBytes, texels.data(), texels.size() * kCornerBytes);
  }
  return values.size() * kCornerBytes;
}

} // namespace

//------------------------------------------------------------------------------
GeometryBuffers::GeometryBuffers(ObjectPool& pool)
  : Positions(pool, GL_RGBA32F)
  , Normals(pool, GL_RGBA32F)
  , Colors(pool, GL_RGBA8)
  , Coordinates(pool, GL_RG32F)
  , Lookups(pool, GL_RGBA8)
  , TrianglePart(pool, GL_R32UI)
  , Layout(pool, GL_RGBA32I)
  , VertexArray(pool.makeVertexArray())
{
}

//------------------------------------------------------------------------------
std::vector<GeometryBuffers::Slot> GeometryBuffers::layOut(const Snapshot& snapshot) const
{
  std::vector<Slot> slots;
  std::int32_t normals = 0, colors = 0, coordinates = 0, lookup = 0;
  for (const Part& part : snapshot.parts)
  {
    const Geometry& geometry = *part.geometry;
    const auto triangles = static_cast<std::int32_t>(geometry.triangleCount());
    Slot slot;
    slot.version = geometry.version;
    slot.key = part.key;
    slot.firstTriangle = part.firstTriangle;
    slot.triangles = geometry.triangleCount();
    if (!geometry.normals.empty())
    {
      slot.normals = normals;
      normals += triangles;
    }
    if (geometry.colorSource == ColorSource::Corner)
    {
      slot.colors = colors;
      colors += triangles;
    }
    if (geometry.colorSource == ColorSource::Lookup)
    {
      slot.coordinates = coordinates;
      coordinates += triangles;
      slot.lookup = lookup;
      lookup += static_cast<std::int32_t>(geometry.lookup.size());
    }
    slots.push_back(slot);
  }
  return slots;
}

//------------------------------------------------------------------------------
bool GeometryBuffers::fits(const Snapshot& snapshot, std::string& error) const
{
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
  const std::uint64_t corners = 3ull * snapshot.triangleCount;
  if (corners > static_cast<std::uint64_t>(limit))
  {
    error = "the scene has " + std::to_string(snapshot.triangleCount) +
      " triangles, this OpenGL context holds at most " + std::to_string(limit / 3) +
      " in a texture buffer";
    return false;
  }
  return true;
}

//------------------------------------------------------------------------------
bool GeometryBuffers::holds(const Snapshot& snapshot) const
{
  if (!this->Uploaded || this->Slots.size() != snapshot.parts.size())
  {
    return false;
  }
  for (std::size_t i = 0; i < this->Slots.size(); ++i)
  {
    const Part& part = snapshot.parts[i];
    if (this->Slots[i].version != part.geometry->version ||
      this->Slots[i].firstTriangle != part.firstTriangle)
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
bool GeometryBuffers::update(const Snapshot& snapshot, std::string& error)
{
  this->UploadedBytes = 0;
  if (this->holds(snapshot))
  {
    return true;
  }
  if (!this->fits(snapshot, error))
  {
    this->Uploaded = false;
    return false;
  }
  const std::vector<Slot> slots = this->layOut(snapshot);
  const bool sameStorage = this->Uploaded && slots.size() == this->Slots.size() &&
    std::equal(slots.begin(), slots.end(), this->Slots.begin(),
      [](const Slot& a, const Slot& b) { return a.samePlace(b); });
  if (!sameStorage)
  {
    this->allocate(snapshot);
  }
  for (std::size_t i = 0; i < slots.size(); ++i)
  {
    if (!sameStorage || slots[i].version != this->Slots[i].version)
    {
      this->uploadPart(snapshot.parts[i], slots[i]);
    }
  }
  this->Slots = slots;
  this->uploadLayout(snapshot);
  this->Uploaded = true;
  return true;
}

//------------------------------------------------------------------------------
void GeometryBuffers::allocate(const Snapshot& snapshot)
{
  std::size_t normals = 0, colors = 0, coordinates = 0, lookups = 0;
  for (const Part& part : snapshot.parts)
  {
    normals += part.geometry->normals.size();
    colors += part.geometry->colors.size();
    coordinates += part.geometry->coordinates.size();
    lookups += part.geometry->lookup.size();
  }
  // Bytes without data: only the storage is made; every part is uploaded into it afterwards.
  const auto reserve = [](TextureBuffer& table, std::size_t bytes) {
    table.upload(nullptr, bytes, GL_STATIC_DRAW);
  };
  reserve(this->Positions, 3 * kCornerBytes * snapshot.triangleCount);
  reserve(this->Normals, kCornerBytes * normals);
  reserve(this->Colors, sizeof(glm::u8vec4) * colors);
  reserve(this->Coordinates, sizeof(glm::vec2) * coordinates);
  reserve(this->Lookups, sizeof(glm::u8vec4) * lookups);
}

//------------------------------------------------------------------------------
void GeometryBuffers::uploadPart(const Part& part, const Slot& slot)
{
  const Geometry& geometry = *part.geometry;
  const auto put = [this](TextureBuffer& table, std::size_t offset, const auto& values) {
    const std::size_t size = sizeof(values[0]);
    if (!values.empty())
    {
      table.uploadRange(offset * size, values.data(), values.size() * size);
      this->UploadedBytes += values.size() * size;
    }
  };
  this->UploadedBytes +=
    uploadPadded(this->Positions, 3ull * slot.firstTriangle, geometry.positions, 1.0f);
  this->UploadedBytes +=
    uploadPadded(this->Normals, 3ull * std::max(slot.normals, 0), geometry.normals, 0.0f);
  put(this->Colors, 3ull * std::max(slot.colors, 0), geometry.colors);
  put(this->Coordinates, 3ull * std::max(slot.coordinates, 0), geometry.coordinates);
  put(this->Lookups, static_cast<std::size_t>(std::max(slot.lookup, 0)), geometry.lookup);
}

//------------------------------------------------------------------------------
void GeometryBuffers::uploadLayout(const Snapshot& snapshot)
{
  std::vector<std::uint32_t> owner(snapshot.triangleCount);
  std::vector<glm::ivec4> layout;
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
  {
    const Part& part = snapshot.parts[i];
    const Slot& slot = this->Slots[i];
    std::fill_n(owner.begin() + part.firstTriangle, slot.triangles, static_cast<std::uint32_t>(i));
    layout.emplace_back(
      static_cast<int>(part.firstTriangle), slot.normals, slot.colors, slot.coordinates);
    layout.emplace_back(std::max(slot.lookup, 0), part.geometry->lookupWidth,
      part.geometry->lookupHeight, 0);
  }
  this->TrianglePart.upload(owner.data(), owner.size() * sizeof(owner[0]), GL_STATIC_DRAW);
  this->Layout.upload(layout.data(), layout.size() * sizeof(layout[0]), GL_STATIC_DRAW);
  this->UploadedBytes += owner.size() * sizeof(owner[0]) + layout.size() * sizeof(layout[0]);
}

//------------------------------------------------------------------------------
void GeometryBuffers::bindForDrawing(GLuint program) const
{
  const GLint position = glGetAttribLocation(program, "position");
  glBindVertexArray(this->VertexArray);
  glBindBuffer(GL_ARRAY_BUFFER, this->Positions.buffer());
  glEnableVertexAttribArray(static_cast<GLuint>(position));
  glVertexAttribPointer(static_cast<GLuint>(position), 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

//------------------------------------------------------------------------------
void GeometryBuffers::draw(const Part& part) const
{
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(3 * part.firstTriangle),
    static_cast<GLsizei>(3 * part.geometry->triangleCount()));
}

//------------------------------------------------------------------------------
void GeometryBuffers::bindTables(int firstUnit) const
{
  const TextureBuffer* tables[kUnits] = { &this->TrianglePart, &this->Positions, &this->Normals,
    &this->Colors, &this->Coordinates, &this->Lookups, &this->Layout };
  for (int i = 0; i < kUnits; ++i)
  {
    tables[i]->bind(firstUnit + i);
  }
}

} // namespace gl
} // namespace hrt
