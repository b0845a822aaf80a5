// Result files: complete or absent; links are followed, devices are written to, and files of one run appear together.

#include <mobil/assets/files/output_file.h>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <thread>

namespace mobil {
namespace {

namespace fs = std::filesystem;

class Output : public testing::Test {
 protected:
  Output() : folder(fs::temp_directory_path() / ("mobil_output_" + std::to_string(::getpid()))) {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  ~Output() override { fs::remove_all(folder); }

  std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(folder), {}); }
  static std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void expect_refused(const Result<void>& done, const std::string& piece) {
    ASSERT_FALSE(done.has_value());
    EXPECT_NE(done.error().message.find(piece), std::string::npos) << done.error().message;
    EXPECT_EQ(done.error().message.find('\n'), std::string::npos);
  }

  fs::path folder;
};

TEST_F(Output, FileIsCreatedAndOverwritten) {
  for (const std::string text : {"first", "second, and longer", ""}) {
    ASSERT_TRUE(write_file(folder / "a.txt", text).has_value());
    EXPECT_EQ(text_of(folder / "a.txt"), text);
    EXPECT_EQ(entries(), 1);
  }
}

TEST_F(Output, PermissionsOfAnOverwrittenFileStay) {
  const auto mode_of = [](const fs::path& file) {
    struct stat about {};
    EXPECT_EQ(::stat(file.c_str(), &about), 0);
    return about.st_mode & 0777U;
  };
  for (const mode_t mode : {0664U, 0600U, 0755U, 0644U}) {
    ASSERT_TRUE(write_file(folder / "a.txt", "first").has_value());
    ASSERT_EQ(::chmod((folder / "a.txt").c_str(), mode), 0);
    ASSERT_TRUE(write_file(folder / "a.txt", "second").has_value());
    EXPECT_EQ(mode_of(folder / "a.txt"), mode);

    auto results = OutputFolder::make(folder);
    ASSERT_TRUE(results.has_value());
    ASSERT_TRUE(write_file(results->inside() / "a.txt", "third").has_value());
    ASSERT_TRUE(results->put().has_value());
    EXPECT_EQ(mode_of(folder / "a.txt"), mode);
    EXPECT_EQ(text_of(folder / "a.txt"), "third");
  }
}

TEST_F(Output, AWriteProtectedFileIsRefused) {
  ASSERT_TRUE(write_file(folder / "a.txt", "first").has_value());
  ASSERT_EQ(::chmod((folder / "a.txt").c_str(), 0444), 0);
  if (::access((folder / "a.txt").c_str(), W_OK) == 0) GTEST_SKIP() << "this user can write everything";
  expect_refused(write_file(folder / "a.txt", "second"), "Permission denied");
  EXPECT_EQ(text_of(folder / "a.txt"), "first");
}

TEST_F(Output, ALinkIsFollowedAndStays) {
  fs::create_directories(folder / "far");
  fs::create_symlink("far/b.txt", folder / "a.txt");  // no target yet
  for (const std::string text : {"first", "second"}) {
    ASSERT_TRUE(write_file(folder / "a.txt", text).has_value());
    EXPECT_TRUE(fs::is_symlink(folder / "a.txt"));
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder / "far" / "b.txt")));
    EXPECT_EQ(text_of(folder / "far" / "b.txt"), text);
  }
}

TEST_F(Output, ALinkWithoutTargetStaysAndIsNamed) {
  fs::create_symlink(folder / "not mounted", folder / "link");
  for (const fs::path& path : {folder / "link", folder / "link" / "below" / "more"}) {
    const auto made = OutputFolder::make(path);
    ASSERT_FALSE(made.has_value());
    EXPECT_NE(made.error().message.find("has no target"), std::string::npos) << made.error().message;
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(entries(), 1);
  }
}

TEST_F(Output, APipeWithoutANameIsWrittenTo) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  EXPECT_TRUE(write_file("/proc/self/fd/" + std::to_string(ends[1]), "through").has_value());
  ::close(ends[1]);
  char got[16] = {};
  EXPECT_EQ(::read(ends[0], got, sizeof got), 7);
  EXPECT_STREQ(got, "through");
  ::close(ends[0]);
}

TEST_F(Output, MessagesDoNotNameTheHiddenFolder) {
  auto results = OutputFolder::make(folder / "out");
  ASSERT_TRUE(results.has_value());
  const auto refused = write_file(results->inside() / "missing" / "a.txt", "text");
  ASSERT_FALSE(refused.has_value());
  EXPECT_TRUE(refused.error().message.starts_with((folder / "out" / "missing" / "a.txt").string()))
      << refused.error().message;
}

TEST_F(Output, APipeIsWrittenToAndStays) {
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const bool through_link : {false, true}) {
    if (through_link) fs::create_symlink(pipe, folder / "link");
    std::string got;
    std::thread reader([&] { got = text_of(pipe); });
    EXPECT_TRUE(write_file(through_link ? folder / "link" : pipe, "through").has_value());
    reader.join();
    EXPECT_EQ(got, "through");
    EXPECT_TRUE(fs::is_fifo(pipe));
  }
}

TEST_F(Output, ADeviceIsNeverReplaced) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  fs::create_symlink("/dev/null", folder / "null");
  EXPECT_TRUE(write_file(folder / "null", "gone").has_value());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  expect_refused(write_file("/dev/full", "more than it holds"), "No space");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Output, FailedWritesLeaveNothing) {
  fs::create_directories(folder / "taken");
  fs::create_symlink("loop", folder / "loop");
  fs::create_symlink("ping", folder / "pong");
  fs::create_symlink("pong", folder / "ping");
  expect_refused(write_file(folder / "taken", "x"), "a folder has that name");
  expect_refused(write_file(folder / "missing" / "a.txt", "x"), "there is no folder");
  expect_refused(write_file(folder / "loop", "x"), "circle");
  expect_refused(write_file(folder / "ping", "x"), "circle");
  EXPECT_FALSE(write_file(folder / std::string(300, 'n'), "x").has_value());
  EXPECT_FALSE(OutputFolder::make(folder / "loop").has_value());
  EXPECT_FALSE(OutputFolder::make(folder / "new" / std::string(300, 'n')).has_value());
  ASSERT_TRUE(write_file(folder / "file", "x").has_value());
  EXPECT_FALSE(OutputFolder::make(folder / "file" / "below").has_value());
  std::string left;
  for (const auto& entry : fs::directory_iterator(folder)) left += entry.path().filename().string().substr(0, 20) + " ";
  EXPECT_EQ(entries(), 5) << left;
}

TEST_F(Output, ResultsOfARunAppearTogether) {
  const fs::path out = folder / "deep" / "out";
  {
    auto results = OutputFolder::make(out);
    ASSERT_TRUE(results.has_value());
    ASSERT_TRUE(write_file(results->inside() / "a", "1").has_value());
  }
  EXPECT_EQ(entries(), 0) << "folders that were made for results that never came";
  for (const std::string text : {"old", "new"}) {
    auto results = OutputFolder::make(out);
    ASSERT_TRUE(results.has_value());
    for (const char* name : {"a", "b"}) ASSERT_TRUE(write_file(results->inside() / name, text).has_value());
    EXPECT_EQ(fs::exists(out / "a"), text == "new");
    ASSERT_TRUE(results->put().has_value());
    for (const char* name : {"a", "b"}) EXPECT_EQ(text_of(out / name), text);
    EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 2);
  }
  {
    auto results = OutputFolder::make(out);
    ASSERT_TRUE(results.has_value());
    for (const char* name : {"a", "b", "c"}) ASSERT_TRUE(write_file(results->inside() / name, "newer").has_value());
    fs::create_directories(out / "c");
    EXPECT_FALSE(results->put().has_value());
  }
  for (const char* name : {"a", "b"}) EXPECT_EQ(text_of(out / name), "new") << "mixed with those of a run that failed";
  EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 3);
}

TEST_F(Output, ForeignFilesInAFolderStay) {
  {
    auto results = OutputFolder::make(folder / "out");
    ASSERT_TRUE(results.has_value());
    ASSERT_TRUE(write_file(folder / "out" / "theirs", "1").has_value());
  }
  EXPECT_EQ(text_of(folder / "out" / "theirs"), "1");
}

TEST_F(Output, LinksAndPipesInAFolderOfResultsStay) {
  const fs::path out = folder / "out";
  fs::create_directories(out);
  fs::create_symlink("../elsewhere", out / "a");
  fs::create_symlink("/dev/null", out / "b");
  auto results = OutputFolder::make(out);
  ASSERT_TRUE(results.has_value());
  for (const char* name : {"a", "b"}) ASSERT_TRUE(write_file(results->inside() / name, "text").has_value());
  ASSERT_TRUE(results->put().has_value());
  EXPECT_EQ(text_of(folder / "elsewhere"), "text");
  EXPECT_TRUE(fs::is_symlink(out / "a") && fs::is_symlink(out / "b"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(OneLine, ControlCharactersAreShownAndLongWordsCut) {
  EXPECT_EQ(fail("--height 180cm: fine, it's \u00b0").value().message, "--height 180cm: fine, it's \u00b0");
  EXPECT_EQ(one_line("a\nb\tc\x1b[31mred\x7f"), "a\\nb\\tc\\x1b[31mred\\x7f");
  const std::string path(255, 'p');
  EXPECT_EQ(one_line("see " + path + " there"), "see " + path + " there");
  const std::string cut = one_line("see " + std::string(50000, 'x') + " there");
  EXPECT_EQ(cut, "see " + std::string(60, 'x') + "... (50000 characters) there");
  std::string words;
  for (int i = 0; i < 10000; ++i) words += "word ";
  EXPECT_LE(one_line(words).size(), 2010U);
  std::string wide;
  for (int i = 0; i < 5000; ++i) wide += "\u20ac";
  const std::string kept = one_line(wide);
  EXPECT_EQ(kept.find("..."), 60U) << "a character of three bytes was cut";
}

/// Pictures of an earlier, longer run are removed; all other files stay.
TEST_F(Output, OldFramesOfANumberedSeriesAreRemoved) {
  const fs::path out = folder / "out";
  const auto put = [&](std::initializer_list<const char*> names, std::string_view numbered) {
    auto results = OutputFolder::make(out);
    ASSERT_TRUE(results) << results.error().message;
    for (const char* name : names) ASSERT_TRUE(write_file(results->inside() / name, name));
    ASSERT_TRUE(results->put(numbered));
  };
  put({"frame_0.png", "frame_1.png", "frame_2.png", "frame_2.txt", "frame_x.png", "frame_.png", "walk.csv"}, {});
  put({"walk.csv"}, "frame_");
  EXPECT_TRUE(fs::exists(out / "frame_2.png")) << "there is no new one";
  put({"frame_0.png", "walk.csv"}, "frame_");
  std::set<std::string> left;
  for (const auto& entry : fs::directory_iterator(out)) left.insert(entry.path().filename().string());
  EXPECT_EQ(left, (std::set<std::string>{"frame_0.png", "frame_2.txt", "frame_x.png", "frame_.png", "walk.csv"}));
}

}  // namespace
}  // namespace mobil
