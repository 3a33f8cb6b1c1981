// Implements the reading of a scene: which file is read, which braces are open, and what each
// command does to the scene. Open files stand on a list of our own, not on the call stack.
#include "IO/BART/AFF/Parser.h"

#include "IO/BART/AFF/Commands.h"

#include <map>
#include <memory>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace hrt
{
namespace bart
{
namespace
{

constexpr int kMostFrames = 10000000;
constexpr int kHighestLevel = 1000000;

class Parser
{
public:
  Parser(FileSource& files, const Limits& limits)
    : Files(files)
    , Most(limits)
  {
  }

  Scene read(const std::string& path)
  {
    this->open(path, {});
    while (!this->Open.empty())
    {
      this->step();
    }
    this->bindNames();
    return std::move(this->Result);
  }

private:
  using Text = std::shared_ptr<const std::string>;
  struct OpenFile
  {
    Text text;
    Lexer lexer;
    std::size_t bracesOutside;
  };
  struct Brace
  {
    int nodeOutside;
    Location location;
  };
  // A mesh that was read before, and where the text goes on after it.
  struct KnownMesh
  {
    int mesh;
    Lexer::Position end;
  };

  Lexer& lexer() { return this->Open.back()->lexer; }

  //----------------------------------------------------------------------------
  // Files

  // Puts a file on top of those that are read. from: of the include, without one for the first
  // file.
  void open(const std::string& path, const std::optional<Location>& from)
  {
    const Location where = from.value_or(Location{ path, 0 });
    const std::string subject = from ? "the included file " + inQuotes(path) + " " : "";
    std::string reason;
    const Text text = this->textOf(path, reason);
    if (!text)
    {
      throw ReadError(where, subject + reason);
    }
    for (const auto& file : this->Open)
    {
      if (file->lexer.path() == path)
      {
        throw ReadError(where, subject + "includes itself");
      }
    }
    if (this->Open.size() >= this->Most.includeDepth || ++this->Includes > this->Most.includes)
    {
      throw ReadError(where, "the scene includes too many files, or too deeply");
    }
    this->Open.push_back(
      std::make_unique<OpenFile>(OpenFile{ text, Lexer(path, *text), this->Braces.size() }));
  }

  // Null, with a reason, for a file that cannot be had.
  Text textOf(const std::string& path, std::string& reason)
  {
    Text& text = this->Texts[path];
    const std::size_t left = this->Most.bytes - this->Bytes;
    if (!text)
    {
      std::string read;
      if (!this->Files.read(path, left, read, reason))
      {
        return nullptr;
      }
      text = std::make_shared<const std::string>(std::move(read));
    }
    if (text->size() > left)
    {
      reason = "makes the scene larger than " + std::to_string(this->Most.bytes) + " bytes";
      return nullptr;
    }
    this->Bytes += text->size();
    return text;
  }

  void close()
  {
    const OpenFile& file = *this->Open.back();
    if (this->Braces.size() > file.bracesOutside)
    {
      throw ReadError(this->Braces.back().location, "this '{' is not closed in its file");
    }
    this->Open.pop_back();
  }

  //----------------------------------------------------------------------------
  // Commands

  void step()
  {
    const std::string_view word = this->lexer().next();
    if (word.empty())
    {
      this->close();
      return;
    }
    using Command = void (Parser::*)();
    static const std::unordered_map<std::string_view, Command> commands = {
      { "v", &Parser::viewpoint }, { "b", &Parser::background }, { "am", &Parser::ambient },
      { "l", &Parser::light }, { "la", &Parser::namedLight }, { "f", &Parser::simpleMaterial },
      { "fm", &Parser::material }, { "c", &Parser::cone }, { "s", &Parser::sphere },
      { "p", &Parser::polygon }, { "pp", &Parser::polygonWithNormals },
      { "tt", &Parser::texturedTriangle }, { "ttp", &Parser::texturedTriangleWithNormals },
      { "tpa", &Parser::animatedTriangle }, { "m", &Parser::mesh }, { "x", &Parser::transform },
      { "xs", &Parser::staticTransform }, { "}", &Parser::endTransform }, { "k", &Parser::keys },
      { "a", &Parser::times }, { "i", &Parser::include }, { "d", &Parser::detailLevel }
    };
    const auto command = commands.find(word);
    if (command == commands.end())
    {
      this->lexer().failExpecting(
        "a command (a am b c d f fm i k l la m p pp s tpa tt ttp v x xs)");
    }
    (this->*command->second)();
  }

  void viewpoint() { this->Result.viewpoint = readViewpoint(this->lexer()); }
  void background() { this->Result.background = this->lexer().vector("the background's colour"); }
  void ambient() { this->Result.ambient = this->lexer().vector("the ambient light's colour"); }
  void detailLevel() { this->Level = this->level("the level of detail"); }
  void material() { this->setMaterial(readMaterial(this->lexer())); }
  void simpleMaterial() { this->setMaterial(readSimpleMaterial(this->lexer())); }
  void polygon() { this->addLooseFace(readPolygon(this->lexer(), false)); }
  void polygonWithNormals() { this->addLooseFace(readPolygon(this->lexer(), true)); }
  void texturedTriangle() { this->addLooseFace(readTexturedTriangle(this->lexer(), false)); }
  void texturedTriangleWithNormals()
  {
    this->addLooseFace(readTexturedTriangle(this->lexer(), true));
  }

  int level(const char* expected)
  {
    return this->lexer().integer(-kHighestLevel, kHighestLevel, expected);
  }

  void times()
  {
    Lexer& lexer = this->lexer();
    this->Result.startTime = lexer.number("the time of the first frame");
    this->Result.endTime =
      lexer.numberBetween(this->Result.startTime, kLargestNumber, "the time of the last frame");
    this->Result.frames = lexer.integer(1, kMostFrames, "the number of frames");
  }

  void include()
  {
    Lexer& lexer = this->lexer();
    const int needed = this->level("the level of detail of an included file");
    const std::string name = lexer.word("the name of a file to include");
    if (needed <= this->Level)
    {
      this->open(pathBeside(lexer.path(), name), lexer.location());
    }
  }

  void keys()
  {
    // As in BART's own reader, later keys for a name replace earlier ones.
    Animation animation = readKeys(this->lexer());
    const int index = static_cast<int>(this->Result.animations.size());
    this->AnimationOf[animation.name] = index;
    this->Result.animations.push_back(std::move(animation));
  }

  void light() { this->addLight(std::string()); }
  void namedLight() { this->addLight(this->lexer().word("the name of a light")); }
  void addLight(const std::string& name)
  {
    PointLight light = readLight(this->lexer());
    light.node = this->Node;
    light.name = name;
    this->checkRoom(this->Result.lights.size(), this->Most.instances, "lights");
    this->Result.lights.push_back(light);
  }

  void setMaterial(const Material& material)
  {
    const glm::dvec3 &a = material.ambient, &d = material.diffuse, &s = material.specular;
    const std::array<double, 12> numbers = { a.x, a.y, a.z, d.x, d.y, d.z, s.x, s.y, s.z,
      material.shininess, material.transmittance, material.indexOfRefraction };
    const auto [known, isNew] =
      this->MaterialOf.emplace(numbers, static_cast<int>(this->Result.materials.size()));
    if (isNew)
    {
      this->Result.materials.push_back(material);
    }
    this->Material = known->second;
  }

  //----------------------------------------------------------------------------
  // Transforms

  void staticTransform()
  {
    bart::Node node;
    node.matrix = readStaticTransform(this->lexer());
    this->beginTransform(std::move(node));
  }

  void transform()
  {
    bart::Node node;
    node.animated = true;
    node.name = this->lexer().word("the name of a transform");
    this->beginTransform(std::move(node));
  }

  void beginTransform(bart::Node node)
  {
    Lexer& lexer = this->lexer();
    lexer.keyword("{");
    this->checkRoom(this->Braces.size(), this->Most.braceDepth, "transforms inside each other");
    this->checkRoom(this->Result.nodes.size(), this->Most.transforms, "transforms");
    this->Braces.push_back({ this->Node, lexer.location() });
    node.parent = this->Node;
    this->Node = static_cast<int>(this->Result.nodes.size());
    this->Result.nodes.push_back(std::move(node));
  }

  void endTransform()
  {
    if (this->Braces.size() <= this->Open.back()->bracesOutside)
    {
      this->lexer().fail("this '}' closes nothing that was opened in its file");
    }
    this->Node = this->Braces.back().nodeOutside;
    this->Braces.pop_back();
  }

  //----------------------------------------------------------------------------
  // Surfaces

  void checkRoom(std::size_t used, std::size_t most, const std::string& what)
  {
    if (used >= most)
    {
      this->lexer().fail("more than " + std::to_string(most) + " " + what);
    }
  }

  template <typename T>
  void addInstance(Instance::Shape shape, std::vector<T>& list, T&& item)
  {
    this->addInstance(shape, static_cast<int>(list.size()));
    list.push_back(std::move(item));
  }

  void addInstance(Instance::Shape shape, int index)
  {
    if (this->Material == kNone)
    {
      this->setMaterial(bart::Material());
    }
    this->checkRoom(this->Result.instances.size(), this->Most.instances, "surfaces");
    this->Result.instances.push_back({ shape, index, this->Node, this->Material });
    this->Loose = false;
  }

  void sphere()
  {
    this->addInstance(Instance::Shape::Sphere, this->Result.spheres, readSphere(this->lexer()));
  }

  void cone()
  {
    this->addInstance(Instance::Shape::Cone, this->Result.cones, readCone(this->lexer()));
  }

  // The same place in the same file is always the same mesh, however often the file is included.
  void mesh()
  {
    Lexer& lexer = this->lexer();
    const auto place = std::make_pair(this->Open.back()->text.get(), lexer.position().offset);
    const auto known = this->MeshAt.find(place);
    if (known != this->MeshAt.end())
    {
      lexer.jump(known->second.end);
      this->addInstance(Instance::Shape::Mesh, known->second.mesh);
      return;
    }
    NamedMesh named = readMesh(lexer);
    named.mesh.texture = this->textureIndex(named.texture);
    const int index = static_cast<int>(this->Result.meshes.size());
    this->addInstance(Instance::Shape::Mesh, this->Result.meshes, std::move(named.mesh));
    this->MeshAt[place] = { index, lexer.position() };
  }

  int textureIndex(const std::string& name)
  {
    if (name.empty())
    {
      return kNone;
    }
    // Looked for beside the file, hence not the same in another folder.
    const auto [known, isNew] = this->TextureOf.emplace(
      pathBeside(this->lexer().path(), name), static_cast<int>(this->Result.textures.size()));
    if (isNew)
    {
      this->Result.textures.push_back({ name, this->lexer().path(), this->lexer().location() });
    }
    return known->second;
  }

  // Whether the last surface is made of loose pieces that the next piece may join.
  bool joins(Instance::Shape shape) const
  {
    return this->Loose && this->Result.instances.back().shape == shape &&
      this->Result.instances.back().node == this->Node &&
      this->Result.instances.back().material == this->Material;
  }

  void addLooseFace(NamedMesh named)
  {
    Mesh& face = named.mesh;
    face.texture = this->textureIndex(named.texture);
    Mesh* last = this->joins(Instance::Shape::Mesh) ? &this->Result.meshes.back() : nullptr;
    if (!last || last->texture != face.texture || last->normals.empty() != face.normals.empty())
    {
      this->addInstance(Instance::Shape::Mesh, this->Result.meshes, std::move(face));
      this->Loose = true;
      return;
    }
    const auto moved = [](int index, std::size_t by)
    { return index == kNone ? kNone : index + static_cast<int>(by); };
    for (const Corner& c : face.corners)
    {
      last->corners.push_back({ moved(c.vertex, last->vertices.size()),
        moved(c.normal, last->normals.size()), moved(c.coordinate, last->coordinates.size()) });
    }
    last->vertices.insert(last->vertices.end(), face.vertices.begin(), face.vertices.end());
    last->normals.insert(last->normals.end(), face.normals.begin(), face.normals.end());
    last->coordinates.insert(
      last->coordinates.end(), face.coordinates.begin(), face.coordinates.end());
    last->faceEnds.push_back(last->corners.size());
  }

  void animatedTriangle()
  {
    AnimatedTriangle triangle = readAnimatedTriangle(this->lexer());
    if (!this->joins(Instance::Shape::AnimatedTriangles))
    {
      this->addInstance(
        Instance::Shape::AnimatedTriangles, this->Result.animatedTriangles, AnimatedTriangles());
      this->Loose = true;
    }
    this->Result.animatedTriangles.back().push_back(std::move(triangle));
  }

  //----------------------------------------------------------------------------
  // Keys may stand after what they move, and after other keys of the same name.
  void bindNames()
  {
    for (bart::Node& node : this->Result.nodes)
    {
      node.animation = node.animated ? this->animationNamed(node.name) : kNone;
    }
    for (PointLight& light : this->Result.lights)
    {
      light.animation = light.name.empty() ? kNone : this->animationNamed(light.name);
    }
    this->Result.camera = this->animationNamed("camera");
  }

  int animationNamed(const std::string& name) const
  {
    const auto found = this->AnimationOf.find(name);
    return found == this->AnimationOf.end() ? kNone : found->second;
  }

  FileSource& Files;
  const Limits Most;
  Scene Result;

  std::vector<std::unique_ptr<OpenFile>> Open;
  std::map<std::string, Text> Texts;
  std::size_t Bytes = 0;
  std::size_t Includes = 0;

  std::vector<Brace> Braces;
  int Node = kNone;
  int Material = kNone;
  int Level = 0;
  bool Loose = false;

  std::map<std::pair<const std::string*, std::size_t>, KnownMesh> MeshAt;
  std::map<std::array<double, 12>, int> MaterialOf;
  std::map<std::string, int> TextureOf;
  std::map<std::string, int> AnimationOf;
};

} // anonymous namespace

//------------------------------------------------------------------------------
Scene readScene(const std::string& path, FileSource& files, const Limits& limits)
{
  return Parser(files, limits).read(path);
}

} // namespace bart
} // namespace hrt
