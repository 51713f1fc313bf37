#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "ExpectError.h"
#include "RawlogFixture.h"

using namespace viwo;
using namespace viwo::testing;
using namespace mrpt::obs;

namespace
{
class RawlogSequenceTest : public RawlogTest
{
   protected:
	/** Observations of [begin, end) ms, one every 10 ms, into a file of that name. */
	std::string part(const std::string& name, int begin_ms, int end_ms)
	{
		RawlogWriter writer(folder.file(name));
		for (int ms = begin_ms; ms < end_ms; ms += 10) writer.write(makeOdometry(kStart_ns + ms * kMillisecond_ns, {}, {}, ms));
		writer.close();
		return folder.file(name);
	}

	static std::vector<int> millisecondsOf(const std::vector<CObservation::Ptr>& observations)
	{
		std::vector<int> ms;
		for (const auto& o : observations) ms.push_back(static_cast<int>((nanosecondsOf(o->timestamp) - kStart_ns) / kMillisecond_ns));
		return ms;
	}
};

std::string actionsWithFrame(int ms)
{
	CActionRobotMovement2D movement;
	movement.timestamp = mrptTime(kStart_ns + ms * kMillisecond_ns);
	movement.computeFromOdometry(mrpt::poses::CPose2D(1, 0, 0), {});
	CActionCollection actions;
	actions.insert(movement);
	PlainRawlog plain;
	plain << actions << CSensoryFrame();
	return plain.bytes();
}
}  // namespace

TEST_F(RawlogSequenceTest, PartsGiveWhatTheWholeGives)
{
	const std::string whole = part("whole.rawlog", 0, 1000), a = part("a.rawlog", 0, 330), b = part("b.rawlog", 330, 340),
	                  c = part("c.rawlog", 340, 1000);
	RawlogReader reader(std::vector<std::string>{a, b, c});
	double last = 0;
	std::vector<CObservation::Ptr> all;
	while (const auto o = reader.next())
	{
		all.push_back(o);
		EXPECT_GE(reader.progress(), last);
		last = reader.progress();
	}
	EXPECT_EQ(millisecondsOf(all), millisecondsOf(readAll(whole)));
	EXPECT_EQ(reader.counts().entries, 100u);
	EXPECT_EQ(reader.counts().late, 0u);
	EXPECT_EQ(reader.path(), c);
	EXPECT_DOUBLE_EQ(last, 1);
}

TEST_F(RawlogSequenceTest, ImagesAreFoundBesideTheirRawlog)
{
	writeSecond(folder.file("a.rawlog"));
	RawlogWriter later(folder.file("b.rawlog"));
	gradientImage().saveToFile(later.imagePath("CAM", kStart_ns + 2000 * kMillisecond_ns, "png"));
	later.write(makeImage(kStart_ns + 2000 * kMillisecond_ns, smallCamera(), Pose3(),
	                      RawlogWriter::imageName("CAM", kStart_ns + 2000 * kMillisecond_ns, "png")));
	later.close();
	RawlogReader reader(std::vector<std::string>{folder.file("a.rawlog"), folder.file("b.rawlog")});
	EXPECT_EQ(readAll(reader).size(), kSecondEntries + 1);
	EXPECT_NE(reader.imagesFolder().find("b_Images"), std::string::npos);
}

TEST_F(RawlogSequenceTest, OdometryOfActionsGoesOn)
{
	writeFile(folder.file("a.rawlog"), actionsWithFrame(0));
	writeFile(folder.file("b.rawlog"), actionsWithFrame(100));
	RawlogReader reader(std::vector<std::string>{folder.file("a.rawlog"), folder.file("b.rawlog")});
	const auto all = readAll(reader);
	ASSERT_EQ(all.size(), 2u);
	EXPECT_NEAR(std::dynamic_pointer_cast<CObservationOdometry>(all[1])->odometry.x(), 2, 1e-12);
}

TEST_F(RawlogSequenceTest, WrongOrderIsToldAndNothingBeforeIsLost)
{
	const std::string a = part("a.rawlog", 0, 3000), b = part("b.rawlog", 3000, 6000);
	RawlogReader reader(std::vector<std::string>{b, a});
	const PartialRead read = readUntilError(reader);
	EXPECT_EQ(read.observations.size(), 300u);
	for (const std::string& part : {a, b, std::string("order of their time"), std::string("5.990 s")})
		EXPECT_NE(read.error.find(part), std::string::npos) << read.error;
}

TEST_F(RawlogSequenceTest, AMissingPartIsToldBeforeAnythingIsRead)
{
	const std::string a = part("a.rawlog", 0, 100);
	expectError([&] { RawlogReader reader(std::vector<std::string>{a, folder.file("none.rawlog")}); }, {"none.rawlog", "no such file"});
	expectError([&] { RawlogReader reader(std::vector<std::string>{}); }, {"no rawlog"});
	expectError([&] { RawlogReader reader(std::vector<std::string>{a, folder.path() + "/./a.rawlog"}); }, {"a.rawlog", "given twice"});
	expectError([&] { RawlogReader reader(std::vector<std::string>{"/dev/stdin", "/dev/stdin"}); }, {"/dev/stdin", "given twice"});
}

TEST_F(RawlogSequenceTest, TruncatedPartEndsTheReadingUnlessAllowed)
{
	const std::string a = part("a.rawlog", 0, 500), b = part("b.rawlog", 500, 1000);
	std::string bytes = readFile(a);
	writeFile(a, bytes.substr(0, bytes.size() - 20));
	RawlogReader strict(std::vector<std::string>{a, b});
	EXPECT_NE(readUntilError(strict).error.find("truncated"), std::string::npos);
	RawlogReaderOptions options;
	options.allow_truncated = true;
	RawlogReader lenient(std::vector<std::string>{a, b}, options);
	const auto ms = millisecondsOf(readAll(lenient));
	EXPECT_TRUE(lenient.truncated());
	EXPECT_EQ(std::count_if(ms.begin(), ms.end(), [](int t) { return t >= 500; }), 50);
}

/** Whoever opens a pipe, and however little comes at a time, sees it from its beginning. */
TEST_F(RawlogSequenceTest, APipeIsReadLikeAFileAndMoreThanOnce)
{
	for (const bool compressed : {true, false})
	{
		std::string bytes = readFile(part("x.rawlog", 0, 3000));
		if (!compressed)
		{
			PlainRawlog plain;
			for (int ms = 0; ms < 3000; ms += 10) plain << makeOdometry(kStart_ns + ms * kMillisecond_ns, {}, {}, ms);
			bytes = plain.bytes();
		}
		const std::string pipe = folder.file(compressed ? "gz_pipe" : "plain_pipe");
		ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
		std::thread feeder(
		    [&]
		    {
			    std::ofstream out(pipe, std::ios::binary);
			    out << bytes.substr(0, 1) << std::flush;
			    for (size_t i = 1; i < bytes.size(); i += 997) out << bytes.substr(i, 997) << std::flush;
		    });
		RawlogReader head(pipe);
		EXPECT_EQ(millisecondsOf({head.next(), head.next()}), (std::vector<int>{0, 10}));
		const auto again = readAll(pipe);
		feeder.join();
		EXPECT_EQ(again.size(), 300u);
		EXPECT_EQ(readAll(head).size(), 298u);
		EXPECT_EQ(readAll(pipe).size(), 300u);
	}
}
