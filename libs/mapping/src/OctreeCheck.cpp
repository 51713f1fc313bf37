#include "OctreeCheck.h"

namespace viwo
{
namespace
{
constexpr unsigned kDeepest = 16;  //!< of liboctomap's trees

/** Walks over the nodes as they stand in the file: depth first, the children of a node in a byte (.ot) or two (.bt). */
class NodeWalk
{
   public:
	NodeWalk(std::istream& file, OctreeFormat format, size_t value_bytes) : file_(file), format_(format), value_bytes_(value_bytes) {}

	bool node(unsigned depth)
	{
		const unsigned inner = format_ == OctreeFormat::ot ? childrenOfValue() : innerChildren();
		if (!file_ || (children_ != 0 && depth == kDeepest)) return false;
		for (unsigned i = 0; i < 8; ++i)
			if ((inner >> i & 1u) != 0 && !node(depth + 1)) return false;
		return true;
	}

   private:
	unsigned childrenOfValue()
	{
		file_.ignore(static_cast<std::streamsize>(value_bytes_));
		return children_ = byte();
	}

	/** Only children with children have data of their own. */
	unsigned innerChildren()
	{
		const unsigned low = byte();
		children_ = low | byte() << 8;
		unsigned inner = 0;
		for (unsigned i = 0; i < 8; ++i)
			if ((children_ >> 2 * i & 3u) == 3u) inner |= 1u << i;
		return inner;
	}

	unsigned byte()
	{
		const int c = file_.get();
		return c < 0 ? 0 : static_cast<unsigned>(c);
	}

	std::istream& file_;
	OctreeFormat format_;
	size_t value_bytes_;
	unsigned children_ = 0;  //!< of the node read last
};
}  // namespace

bool isWholeOctree(std::istream& file, OctreeFormat format, size_t value_bytes)
{
	const std::istream::pos_type begin = file.tellg();
	const bool is_whole = NodeWalk(file, format, value_bytes).node(0);
	file.clear();
	file.seekg(begin);
	return is_whole;
}
}  // namespace viwo
