#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/core/TimeText.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <filesystem>

#include "GzipArchive.h"

namespace fs = std::filesystem;

namespace viwo
{
struct RawlogWriter::Impl
{
	explicit Impl(const std::string& path) : path(path), file(path), archive(file.stream()) {}

	std::string path, images_folder;
	AtomicFile file;
	GzipArchiveWriter archive;
};

RawlogWriter::RawlogWriter(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::obs::CObservation& observation)
{
	impl_->archive.WriteObject(observation);
}

void RawlogWriter::close()
{
	impl_->archive.finish();
	impl_->file.commit();
}

const std::string& RawlogWriter::imagesFolder()
{
	if (impl_->images_folder.empty())
	{
		const fs::path rawlog(impl_->path);
		const std::string folder = (rawlog.parent_path() / (rawlog.stem().string() + "_Images")).string();
		std::error_code error;
		fs::create_directories(folder, error);
		if (error) throw Error(folder + ": cannot create this folder: " + error.message());
		impl_->images_folder = folder;
	}
	return impl_->images_folder;
}

std::string RawlogWriter::imageName(const std::string& label, int64_t t_ns, const std::string& extension)
{
	return label + "_" + formatSeconds(t_ns) + "." + extension;
}

std::string RawlogWriter::imagePath(const std::string& label, int64_t t_ns, const std::string& extension)
{
	return imagesFolder() + "/" + imageName(label, t_ns, extension);
}
}  // namespace viwo
