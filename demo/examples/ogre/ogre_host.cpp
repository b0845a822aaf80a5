// Dressed people walk in a scene of OGRE 1.12, with shadows. Each person is a node that is culled by the bounds of the
// written skin, and drawn in one of three levels of detail. The last picture goes to a file.
//
//   ogre_host [PEOPLE] [PICTURE]     for example: ogre_host 24 people.png

#include <Ogre.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <mobil/simulation.h>
#include <mobil/skin_writer.h>
#include <mobil/systems/poses/roots.h>

namespace {

constexpr std::array details{mobil::SkinDetail::near, mobil::SkinDetail::far, mobil::SkinDetail::distant};
constexpr std::array until_m{6.0F, 10.0F, 1e9F};  // distance up to which a level is drawn
constexpr std::size_t vertex_bytes = 6 * sizeof(float);
using Colour = Ogre::ColourValue;
/// Materials; the first ones are those of each SkinPart.
const std::vector<std::pair<std::string, Colour>> materials{
    {"skin", Colour(.81F, .62F, .5F)},   {"legs", Colour(.81F, .62F, .5F)},     {"lips", Colour(.6F, .3F, .25F)},
    {"hair", Colour(.2F, .12F, .07F)},   {"shirt_0", Colour(.2F, .3F, .5F)},    {"shorts", Colour(.25F, .25F, .28F)},
    {"shoes", Colour(.15F, .1F, .08F)},  {"shirt_1", Colour(.55F, .15F, .13F)}, {"shirt_2", Colour(.2F, .4F, .2F)},
    {"shirt_3", Colour(.8F, .8F, .78F)}, {"ground", Colour(.5F, .53F, .5F)}};

struct Level {
  mobil::SkinShape shape;
  Ogre::Entity* drawn = nullptr;
  Ogre::HardwareVertexBufferSharedPtr vertices;
};
struct Figure {
  mobil::Entity person;
  Ogre::SceneNode* node = nullptr;  // at the person's root
  std::array<Level, details.size()> levels;
  std::size_t level = 0;
  std::array<mobil::Vec3<float>, 2> bounds{{{-1, 0, -1}, {1, 2.2F, 1}}};  // of the last vertices, from the node
};
/// Data that people share: skins of similar builds, and the triangles of each sex and detail.
struct Wardrobe {
  mobil::BodySkins skins;
  std::map<const mobil::SkinMesh*, Ogre::HardwareIndexBufferSharedPtr> triangles;
};

template <class T>
T need(mobil::Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
    std::exit(2);
  }
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

Ogre::AxisAlignedBox box(const std::array<mobil::Vec3<float>, 2>& bounds, float wider_m = 0) {
  const auto& [low, high] = bounds;
  return {low.x - wider_m, low.y - wider_m, low.z - wider_m, high.x + wider_m, high.y + wider_m, high.z + wider_m};
}

/// Makes a mesh with its own vertices, shared triangles, and a submesh for each part of the skin.
Level make_level(Ogre::SceneNode& node, const mobil::BodyRequest& body, mobil::SkinDetail detail, Wardrobe& wardrobe,
                 std::size_t number) {
  auto& buffers = Ogre::HardwareBufferManager::getSingleton();
  Level level{.shape = need(wardrobe.skins.of(body, detail))};
  const mobil::SkinMesh& skin = mobil::skin_mesh(body.sex, detail);
  auto& triangles = wardrobe.triangles[&skin];
  if (!triangles) {
    triangles = buffers.createIndexBuffer(Ogre::HardwareIndexBuffer::IT_32BIT, skin.triangle.size(),
                                          Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
    triangles->writeData(0, triangles->getSizeInBytes(), skin.triangle.data());
  }
  const std::string name = "person_" + std::to_string(number) + "_" + std::to_string(static_cast<int>(detail));
  const auto mesh = Ogre::MeshManager::getSingleton().createManual(name, Ogre::RGN_DEFAULT);
  auto* data = mesh->sharedVertexData = new Ogre::VertexData;
  data->vertexCount = level.shape.skin->rest.size();
  data->vertexDeclaration->addElement(0, 0, Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  data->vertexDeclaration->addElement(0, vertex_bytes / 2, Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  level.vertices = buffers.createVertexBuffer(vertex_bytes, data->vertexCount,
                                              Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE);
  data->vertexBufferBinding->setBinding(0, level.vertices);
  for (std::size_t part = 0; part < mobil::skin_parts; ++part) {
    // OGRE draws a submesh without indices as all vertices. Distant skins have no lips.
    if (skin.first_triangle[part] == skin.first_triangle[part + 1]) continue;
    Ogre::SubMesh* sub = mesh->createSubMesh();
    sub->indexData->indexBuffer = triangles;
    sub->indexData->indexStart = 3 * skin.first_triangle[part];
    sub->indexData->indexCount = 3 * skin.first_triangle[part + 1] - sub->indexData->indexStart;
    const bool shirt = part == static_cast<std::size_t>(mobil::SkinPart::shirt);
    sub->setMaterialName(shirt ? "shirt_" + std::to_string(number % 4) : materials[part].first);
  }
  mesh->load();
  level.drawn = node.getCreator()->createEntity(mesh);
  level.drawn->setVisible(false);
  node.attachObject(level.drawn);
  return level;
}

Ogre::Camera* make_scene(Ogre::SceneManager& scene) {
  scene.setAmbientLight(Colour(0.4F, 0.42F, 0.45F));
  scene.setShadowTechnique(Ogre::SHADOWTYPE_TEXTURE_MODULATIVE);
  scene.setShadowTextureSize(2048);
  scene.setShadowFarDistance(25);
  scene.setShadowColour(Colour(0.6F, 0.6F, 0.65F));
  for (const auto& [name, colour] : materials) {
    const auto material = Ogre::MaterialManager::getSingleton().create(name, Ogre::RGN_DEFAULT);
    material->setDiffuse(colour);
    material->setAmbient(colour);
  }
  auto* root = scene.getRootSceneNode();
  Ogre::Light* sun = scene.createLight();
  sun->setType(Ogre::Light::LT_DIRECTIONAL);
  root->createChildSceneNode()->attachObject(sun);
  sun->getParentSceneNode()->setDirection(-0.5F, -1, -0.4F);
  Ogre::MeshManager::getSingleton().createPlane("ground", Ogre::RGN_DEFAULT, {Ogre::Vector3::UNIT_Y, 0}, 80, 80, 40, 40,
                                                true, 1, 1, 1, Ogre::Vector3::UNIT_Z);
  Ogre::Entity* ground = scene.createEntity("ground");
  ground->setMaterialName("ground");
  ground->setCastShadows(false);
  root->attachObject(ground);
  Ogre::Camera* camera = scene.createCamera("camera");
  camera->setNearClipDistance(0.1F);
  camera->setAutoAspectRatio(true);
  auto* eye = root->createChildSceneNode(Ogre::Vector3(3, 2.2F, 7));
  eye->attachObject(camera);
  eye->lookAt({0, 0.7F, 0}, Ogre::Node::TS_WORLD);
  return camera;
}

Figure make_figure(mobil::Simulation& simulation, Ogre::SceneManager& scene, Wardrobe& wardrobe, std::size_t number) {
  const float height_m = 1.58F + 0.02F * static_cast<float>(number % 16);
  const mobil::BodyRequest body{.height_m = height_m,
                                .mass_kg = (number % 3 == 0 ? 27 : 22) * height_m * height_m,
                                .sex = number % 2 == 0 ? mobil::Sex::woman : mobil::Sex::man};
  Figure figure{.person = need(simulation.spawn(body, {.speed_m_s = 1.0F + 0.05F * static_cast<float>(number % 9)})),
                .node = scene.getRootSceneNode()->createChildSceneNode()};
  // Six a row. The first row is behind the camera.
  const float row = static_cast<float>(number / 6), column = static_cast<float>(number % 6);
  need(simulation.place(figure.person, 1.1F * column - 3, number < 6 ? 10 : 2.5F - 2.5F * row + 0.3F * column, 0));
  for (std::size_t i = 0; i < details.size(); ++i)
    figure.levels[i] = make_level(*figure.node, body, details[i], wardrobe, number);
  return figure;
}

/// Moves people to the instant `ahead_s` after the last tick, and writes the skins of those in view. Returns their
/// number by level of detail. The margin of 2 m is for shadows of people outside the picture.
std::array<std::size_t, details.size()> update(const mobil::Simulation& simulation, std::vector<Figure>& figures,
                                               const Ogre::Camera& camera, mobil::SkinWriter& writer, double ahead_s) {
  std::vector<mobil::SkinRequest> requests;
  std::array<std::size_t, details.size()> in_view{};
  for (Figure& figure : figures) {
    mobil::Root root;
    need(simulation.roots({&figure.person, 1}, {&root, 1}, ahead_s));
    const mobil::Vec3<float> origin{static_cast<float>(root.x_m), 0, static_cast<float>(root.z_m)};
    figure.node->setPosition(origin.x, origin.y, origin.z);
    auto wide = box(figure.bounds, 2);
    wide.transform(figure.node->_getFullTransform());
    figure.levels[figure.level].drawn->setVisible(false);
    if (!camera.isVisible(wide)) continue;
    const float distance_m = figure.node->getPosition().distance(camera.getDerivedPosition());
    const std::size_t before = figure.level;  // is kept 10 % longer, so that levels do not flicker
    for (figure.level = 0; distance_m > until_m[figure.level] * (figure.level == before ? 1.1F : 1);) ++figure.level;
    Level& level = figure.levels[figure.level];
    level.drawn->setVisible(true);
    ++in_view[figure.level];
    const std::span bytes(static_cast<std::byte*>(level.vertices->lock(Ogre::HardwareBuffer::HBL_DISCARD)),
                          level.vertices->getSizeInBytes());
    requests.push_back({.person = figure.person,
                        .shape = level.shape,
                        .positions = {bytes, vertex_bytes},
                        .normals = {bytes.subspan(vertex_bytes / 2), vertex_bytes},
                        .origin_m = origin,
                        .ahead_s = ahead_s,
                        .bounds = &figure.bounds});
  }
  need(writer.write(simulation.world(), requests));
  for (Figure& figure : figures) {
    Level& level = figure.levels[figure.level];
    if (!level.vertices->isLocked()) continue;
    level.vertices->unlock();
    level.drawn->getMesh()->_setBounds(box(figure.bounds), false);
  }
  return in_view;
}

}  // namespace

void run(std::size_t people, const char* picture) {
  mobil::Simulation simulation;
  Ogre::LogManager log;
  log.createLog("", true, false, true);  // neither a file nor the console
  Ogre::Root root("", "", "");
  root.loadPlugin(OGRE_PLUGINS "/RenderSystem_GL");
  root.loadPlugin(OGRE_PLUGINS "/Codec_STBI");
  root.setRenderSystem(root.getAvailableRenderers().front());
  root.initialise(false);
  Ogre::RenderWindow* window = root.createRenderWindow("mobil", 960, 640, false);
  auto& resources = Ogre::ResourceGroupManager::getSingleton();
  resources.addResourceLocation(OGRE_MEDIA "/ShadowVolume", "FileSystem", Ogre::RGN_INTERNAL);
  resources.initialiseAllResourceGroups();
  Ogre::SceneManager* scene = root.createSceneManager();
  Ogre::Camera* camera = make_scene(*scene);
  window->addViewport(camera)->setBackgroundColour(Colour(0.65F, 0.72F, 0.8F));

  double spent_ms[3]{};
  const auto timed = [](double& ms, const auto& work) {
    const auto from = std::chrono::steady_clock::now();
    work();
    ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - from).count();
  };
  Wardrobe wardrobe;
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < people; ++i) figures.push_back(make_figure(simulation, *scene, wardrobe, i));
  mobil::SkinWriter writer;
  constexpr int frames = 60;
  std::array<std::size_t, details.size()> in_view{};
  for (int frame = 0; frame < frames; ++frame) {
    double ahead_s = 0;
    timed(spent_ms[0], [&] { ahead_s = simulation.advance(1.0 / 40).alpha * simulation.tick_s(); });
    timed(spent_ms[1], [&] { in_view = update(simulation, figures, *camera, writer, ahead_s); });
    timed(spent_ms[2], [&] { root.renderOneFrame(); });
  }
  std::printf("%zu people; in view %zu near, %zu far, %zu distant\n", people, in_view[0], in_view[1], in_view[2]);
  std::printf("ms a frame: ticks %.2f, skins %.2f, drawing %.1f\n", spent_ms[0] / frames, spent_ms[1] / frames,
              spent_ms[2] / frames);
  if (picture != nullptr) window->writeContentsToFile(picture);
}

int main(int arguments, char** argument) {
  char* end = nullptr;
  const long people = arguments > 1 ? std::strtol(argument[1], &end, 10) : 24;
  if (people < 0 || people > 500 || (end != nullptr && (end == argument[1] || *end != 0)))
    return std::fprintf(stderr, "ogre_host '%s': give a number of people, 0 to 500\n", argument[1]), 2;
  try {
    run(static_cast<std::size_t>(people), arguments > 2 ? argument[2] : nullptr);
  } catch (const Ogre::Exception& error) {
    return std::fprintf(stderr, "ogre_host: %s\n", error.getDescription().c_str()), 1;
  }
  return 0;
}
