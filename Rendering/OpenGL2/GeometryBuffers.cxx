// See GeometryBuffers.h.
#include "Rendering/OpenGL2/GeometryBuffers.h"

#include "Rendering/OpenGL2/PartTables.h"
#include "Rendering/OpenGL2/VertexOrder.h"

#include <algorithm>

namespace hrt
{
namespace gl
{
namespace
{

// Values a chunk while they are brought into the order of the tables: less than 1 MiB.
constexpr std::size_t kChunk = 1 << 16;

// Uploads values in chunks rather than from a copy of the whole mesh: `each(put)` calls put(value) for
// one after the other. Returns their bytes. `first`: the place of the first one in the table.
template <class T, class Each>
std::size_t uploadEach(TextureBuffer& table, std::size_t first, Each each)
{
  std::vector<T> chunk;
  std::size_t done = 0;
  const auto flush = [&] {
    table.uploadRange((first + done) * sizeof(T), chunk.data(), chunk.size() * sizeof(T));
    done += chunk.size();
    chunk.clear();
  };
  each([&](const T& value) {
    chunk.push_back(value);
    if (chunk.size() == kChunk)
    {
      flush();
    }
  });
  flush();
  return done * sizeof(T);
}

template <class T>
std::size_t uploadAll(TextureBuffer& table, std::size_t first, const std::vector<T>& values)
{
  table.uploadRange(first * sizeof(T), values.data(), values.size() * sizeof(T));
  return values.size() * sizeof(T);
}

// Values of a mesh' vertices, in the order in which these are drawn.
template <class T>
std::size_t uploadOrdered(TextureBuffer& table, std::size_t first, const VertexOrder& order,
  const std::vector<T>& values)
{
  return uploadEach<T>(table, first, [&](auto put) {
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      put(values[order.vertexAt(i)]);
    }
  });
}

template <class T>
std::size_t uploadAttribute(TextureBuffer& table, std::int32_t first, const VertexOrder& order,
  const Attribute<T>& attribute)
{
  if (attribute.empty())
  {
    return 0;
  }
  return attribute.attachment == Attachment::Vertices
    ? uploadOrdered(table, static_cast<std::size_t>(first), order, attribute.values)
    : uploadAll(table, static_cast<std::size_t>(first), attribute.values);
}

} // namespace

//------------------------------------------------------------------------------
glm::dmat4 bufferToWorld(const Part& part)
{
  if (!part.copies)
  {
    return part.positionsToWorld();
  }
  glm::dmat4 m = part.localToWorld;
  m[3] = m * glm::dvec4(part.copies->origin, 1.0);
  return m;
}

//------------------------------------------------------------------------------
bool GeometryBuffers::Slot::samePlace(const Slot& o) const
{
  return this->firstTriangle == o.firstTriangle && this->place == o.place &&
    this->triangles == o.triangles && this->copies == o.copies &&
    this->firstCopy == o.firstCopy && this->copyTexels == o.copyTexels &&
    this->firstVertex == o.firstVertex && this->vertices == o.vertices &&
    this->normals == o.normals && this->normalsOf == o.normalsOf && this->colors == o.colors &&
    this->colorsOf == o.colorsOf && this->coordinates == o.coordinates &&
    this->textureCoordinates == o.textureCoordinates && this->lookup == o.lookup &&
    this->sides == o.sides;
}

//------------------------------------------------------------------------------
GeometryBuffers::GeometryBuffers(ObjectPool& pool)
  : Positions(pool, GL_RGBA32F)
  , Indices(pool, GL_R32UI)
  , Normals(pool, GL_R32F)
  , Colors(pool, GL_RGBA8)
  , Coordinates(pool, GL_RG32F)
  , Lookups(pool, GL_RGBA8)
  , TrianglePart(pool, GL_R32UI)
  , Layout(pool, GL_RGBA32I)
  , Sides(pool, GL_RGBA32I)
  , VertexArray(pool.makeVertexArray())
  , EmptyVertexArray(pool.makeVertexArray())
{
}

//------------------------------------------------------------------------------
std::vector<GeometryBuffers::Slot> GeometryBuffers::layOut(
  const Snapshot& snapshot, Sizes& sizes) const
{
  std::vector<Slot> slots;
  slots.reserve(snapshot.parts.size());
  for (const Part& part : snapshot.parts)
  {
    const Geometry& mesh = *part.geometry;
    const std::size_t i = slots.size();
    Slot slot;
    slot.version = mesh.version;
    slot.key = part.key;
    slot.firstTriangle = part.firstTriangle;
    slot.triangles = mesh.triangleCount();
    slot.vertices = i < this->Slots.size() && this->Slots[i].version == mesh.version
      ? this->Slots[i].vertices
      : VertexOrder::sizeFor(mesh);
    const auto reserve = [](std::size_t& used, std::size_t count) {
      const auto first = static_cast<std::int32_t>(used);
      used += count;
      return first;
    };
    const auto reserveAttribute = [&](std::size_t& used, const auto& attribute) {
      return attribute.empty() ? -1
        : reserve(used,
            attribute.attachment == Attachment::Vertices ? slot.vertices : slot.triangles);
    };
    slot.place = sizes.triangles;
    sizes.triangles += slot.triangles;
    slot.firstVertex = reserve(sizes.vertices, slot.vertices);
    slot.normals = reserveAttribute(sizes.normals, mesh.normals);
    slot.normalsOf = mesh.normals.attachment;
    slot.colors = reserveAttribute(sizes.colors, mesh.colors);
    slot.colorsOf = mesh.colors.attachment;
    slot.coordinates = reserveAttribute(sizes.coordinates, mesh.coordinates);
    slot.textureCoordinates = reserveAttribute(sizes.coordinates, mesh.textureCoordinates);
    slot.lookup = mesh.lookup.empty() ? -1 : reserve(sizes.lookups, mesh.lookup.size());
    slot.sides = mesh.sides.empty() ? -1 : reserve(sizes.sides, mesh.sides.size());
    if (part.copies)
    {
      slot.copiesVersion = part.copies->version;
      slot.copies = part.copies->count();
      slot.copyTexels = part.copies->colors.empty() ? 3 : 4;
      slot.firstCopy =
        reserve(sizes.copyTexels, slot.copies * static_cast<std::size_t>(slot.copyTexels));
    }
    slots.push_back(slot);
  }
  for (Slot& slot : slots)
  {
    slot.firstCopy += static_cast<std::int32_t>(sizes.vertices);
  }
  return slots;
}

//------------------------------------------------------------------------------
bool GeometryBuffers::fits(const Sizes& sizes, std::string& error) const
{
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
  const auto most = static_cast<std::size_t>(limit) / 3;
  if (sizes.triangles > most || sizes.vertices > most)
  {
    error = "the scene has " + std::to_string(sizes.triangles) + " triangles and draws " +
      std::to_string(sizes.vertices) + " vertices, this OpenGL context holds at most " +
      std::to_string(most) + " of either in a texture buffer";
    return false;
  }
  if (sizes.vertices + sizes.copyTexels > static_cast<std::size_t>(limit))
  {
    error = "the scene's glyphs and vertices need " +
      std::to_string(sizes.vertices + sizes.copyTexels) +
      " texels, this OpenGL context holds at most " + std::to_string(limit) +
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
      this->Slots[i].firstTriangle != part.firstTriangle ||
      this->Slots[i].copiesVersion != (part.copies ? part.copies->version : 0))
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
  Sizes sizes;
  const std::vector<Slot> slots = this->layOut(snapshot, sizes);
  if (!this->fits(sizes, error))
  {
    this->Uploaded = false;
    return false;
  }
  const bool sameStorage = this->Uploaded && slots.size() == this->Slots.size() &&
    std::equal(slots.begin(), slots.end(), this->Slots.begin(),
      [](const Slot& a, const Slot& b) { return a.samePlace(b); });
  if (!sameStorage)
  {
    this->allocate(sizes);
    this->uploadOwners(snapshot);
  }
  for (std::size_t i = 0; i < slots.size(); ++i)
  {
    const bool newMesh = !sameStorage || slots[i].version != this->Slots[i].version;
    if (newMesh)
    {
      this->uploadPart(snapshot.parts[i], slots[i]);
    }
    // The mesh's origin is in the copies' rows.
    if (slots[i].copiesVersion != 0 &&
      (newMesh || slots[i].copiesVersion != this->Slots[i].copiesVersion))
    {
      this->uploadCopies(snapshot.parts[i], slots[i]);
    }
  }
  this->Slots = slots;
  this->uploadLayout(snapshot);
  this->Uploaded = true;
  return true;
}

//------------------------------------------------------------------------------
void GeometryBuffers::allocate(const Sizes& sizes)
{
  // Bytes without data: only the storage is made; every part is uploaded into it afterwards.
  const auto reserve = [](TextureBuffer& table, std::size_t bytes) {
    table.upload(nullptr, bytes, GL_STATIC_DRAW);
  };
  reserve(this->Positions, sizeof(glm::vec4) * (sizes.vertices + sizes.copyTexels));
  reserve(this->Indices, 3 * sizeof(std::uint32_t) * sizes.triangles);
  reserve(this->Normals, sizeof(glm::vec3) * sizes.normals);
  reserve(this->Colors, sizeof(glm::u8vec4) * sizes.colors);
  reserve(this->Coordinates, sizeof(glm::vec2) * sizes.coordinates);
  reserve(this->Lookups, sizeof(glm::u8vec4) * sizes.lookups);
  reserve(this->Sides, sizeof(TriangleSides) * sizes.sides);
  reserve(this->TrianglePart, sizeof(std::uint32_t) * sizes.triangles);
}

//------------------------------------------------------------------------------
void GeometryBuffers::uploadPart(const Part& part, const Slot& slot)
{
  const Geometry& mesh = *part.geometry;
  const VertexOrder order(mesh);
  const auto first = static_cast<std::uint32_t>(slot.firstVertex);
  this->UploadedBytes += uploadEach<glm::vec4>(this->Positions, first, [&](auto put) {
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      put(glm::vec4(mesh.positions[order.vertexAt(i)], 1.0f));
    }
  });
  using Corners = std::array<std::uint32_t, 3>;
  this->UploadedBytes += uploadEach<Corners>(this->Indices, slot.place, [&](auto put) {
    order.forEachTriangle(
      [&](const Corners& c) { put({ first + c[0], first + c[1], first + c[2] }); });
  });
  this->UploadedBytes += uploadAttribute(this->Normals, slot.normals, order, mesh.normals);
  this->UploadedBytes += uploadAttribute(this->Colors, slot.colors, order, mesh.colors);
  this->UploadedBytes +=
    uploadAttribute(this->Coordinates, slot.coordinates, order, mesh.coordinates);
  this->UploadedBytes += uploadAttribute(
    this->Coordinates, slot.textureCoordinates, order, mesh.textureCoordinates);
  if (!mesh.lookup.empty())
  {
    this->UploadedBytes +=
      uploadAll(this->Lookups, static_cast<std::size_t>(slot.lookup), mesh.lookup);
  }
  if (!mesh.sides.empty())
  {
    this->UploadedBytes +=
      uploadAll(this->Sides, static_cast<std::size_t>(slot.sides), mesh.sides);
  }
}

//------------------------------------------------------------------------------
void GeometryBuffers::uploadCopies(const Part& part, const Slot& slot)
{
  const Copies& copies = *part.copies;
  const glm::dvec3 origin = part.geometry->origin;
  const auto first = static_cast<std::size_t>(slot.firstCopy);
  this->UploadedBytes += uploadEach<glm::vec4>(this->Positions, first, [&](auto put) {
    for (std::size_t i = 0; i < copies.count(); ++i)
    {
      // From positions, without the mesh's origin, to the part's coordinates less the copies' origin.
      for (const glm::vec4& row : copies.rows[i])
      {
        const double shift = glm::dot(glm::dvec3(row), origin);
        put(glm::vec4(glm::vec3(row), static_cast<float>(static_cast<double>(row.w) + shift)));
      }
      if (!copies.colors.empty())
      {
        put(glm::vec4(copies.colors[i]) / 255.0f);
      }
    }
  });
}

//------------------------------------------------------------------------------
void GeometryBuffers::uploadOwners(const Snapshot& snapshot)
{
  this->UploadedBytes += uploadEach<std::uint32_t>(this->TrianglePart, 0, [&](auto put) {
    for (std::uint32_t i = 0; i < snapshot.parts.size(); ++i)
    {
      for (std::size_t k = snapshot.parts[i].geometry->triangleCount(); k > 0; --k)
      {
        put(i);
      }
    }
  });
}

//------------------------------------------------------------------------------
void GeometryBuffers::uploadLayout(const Snapshot& snapshot)
{
  std::vector<glm::ivec4> layout;
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
  {
    const Slot& slot = this->Slots[i];
    const Geometry& mesh = *snapshot.parts[i].geometry;
    layout.emplace_back(
      static_cast<int>(slot.firstTriangle), slot.normals, slot.colors, slot.coordinates);
    layout.emplace_back(
      std::max(slot.lookup, 0), mesh.lookupWidth, mesh.lookupHeight, slot.firstVertex);
    layout.emplace_back(slot.normalsOf == Attachment::Triangles ? 1 : 0,
      slot.colorsOf == Attachment::Triangles ? 1 : 0, slot.textureCoordinates, slot.sides);
    layout.emplace_back(static_cast<int>(slot.place),
      slot.copiesVersion == 0 ? 0 : static_cast<int>(slot.triangles), slot.firstCopy,
      slot.copyTexels);
  }
  this->Layout.upload(layout.data(), layout.size() * sizeof(layout[0]), GL_STATIC_DRAW);
  this->UploadedBytes += layout.size() * sizeof(layout[0]);
}

//------------------------------------------------------------------------------
void GeometryBuffers::bindForDrawing(GLuint program) const
{
  const GLint position = glGetAttribLocation(program, "position");
  glBindVertexArray(this->VertexArray);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, this->Indices.buffer());
  glBindBuffer(GL_ARRAY_BUFFER, this->Positions.buffer());
  glEnableVertexAttribArray(static_cast<GLuint>(position));
  glVertexAttribPointer(static_cast<GLuint>(position), 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

//------------------------------------------------------------------------------
void GeometryBuffers::draw(
  std::size_t part, DrawThrottle& throttle, const std::function<void(int)>& copiesBefore) const
{
  const Slot& slot = this->Slots[part];
  const auto placeOf = [&](std::size_t triangle) {
    return reinterpret_cast<const void*>(3 * sizeof(std::uint32_t) * (slot.place + triangle));
  };
  if (slot.copiesVersion == 0)
  {
    throttle.draw(slot.triangles, 1, [&](std::size_t first, std::size_t count) {
      glDrawElements(
        GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT, placeOf(first));
    });
    return;
  }
  throttle.draw(slot.copies, slot.triangles, [&](std::size_t first, std::size_t count) {
    copiesBefore(static_cast<int>(first));
    glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(3 * slot.triangles),
      GL_UNSIGNED_INT, placeOf(0), static_cast<GLsizei>(count));
  });
}

//------------------------------------------------------------------------------
int GeometryBuffers::vertexToTriangle(std::size_t part) const
{
  const Slot& slot = this->Slots[part];
  return static_cast<int>(slot.firstTriangle) - slot.firstVertex;
}

//------------------------------------------------------------------------------
void GeometryBuffers::bindForFetching() const
{
  glBindVertexArray(this->EmptyVertexArray);
}

//------------------------------------------------------------------------------
void GeometryBuffers::drawCorners(
  std::size_t part, DrawThrottle& throttle, const std::function<void(int)>& copiesBefore) const
{
  const Slot& slot = this->Slots[part];
  if (slot.copiesVersion == 0)
  {
    throttle.draw(slot.triangles, 1, [&](std::size_t first, std::size_t count) {
      glDrawArrays(GL_TRIANGLES, static_cast<GLint>(3 * (slot.place + first)),
        static_cast<GLsizei>(3 * count));
    });
    return;
  }
  throttle.draw(slot.copies, slot.triangles, [&](std::size_t first, std::size_t count) {
    copiesBefore(static_cast<int>(first));
    glDrawArraysInstanced(GL_TRIANGLES, static_cast<GLint>(3 * slot.place),
      static_cast<GLsizei>(3 * slot.triangles), static_cast<GLsizei>(count));
  });
}

//------------------------------------------------------------------------------
int GeometryBuffers::cornerToTriangle(std::size_t part) const
{
  const Slot& slot = this->Slots[part];
  return static_cast<int>(slot.firstTriangle) - static_cast<int>(slot.place);
}

//------------------------------------------------------------------------------
GeometryBuffers::CopyPlace GeometryBuffers::copies(std::size_t part) const
{
  const Slot& slot = this->Slots[part];
  return { slot.firstCopy, slot.copyTexels, static_cast<int>(slot.triangles) };
}

//------------------------------------------------------------------------------
void GeometryBuffers::bindTables(int firstUnit) const
{
  const TextureBuffer* tables[kUnits] = { &this->TrianglePart, &this->Indices, &this->Positions,
    &this->Normals, &this->Colors, &this->Coordinates, &this->Lookups, &this->Layout,
    &this->Sides };
  for (int i = 0; i < kUnits; ++i)
  {
    tables[i]->bind(firstUnit + i);
  }
}

} // namespace gl
} // namespace hrt
