#pragma once

#include <octomap/OcTree.h>

#include <cstdint>
#include <vector>

namespace viwo
{
/** The voxels of one scan: a hash table with open addressing that is emptied at no cost. */
class KeySetOfScan
{
   public:
	KeySetOfScan() : slots_(size_t{1} << kFirstBits), bits_(kFirstBits) {}

	void clear()
	{
		count_ = 0;
		if (++stamp_ != 0) return;
		slots_.assign(slots_.size(), 0);
		stamp_ = 1;
	}

	/** @return whether it is new. */
	bool insert(const octomap::OcTreeKey& key)
	{
		const uint64_t packed = uint64_t{key[0]} | uint64_t{key[1]} << 16 | uint64_t{key[2]} << 32;
		if (!put(packed)) return false;
		if (2 * ++count_ > slots_.size()) grow();
		return true;
	}

   private:
	static constexpr int kFirstBits = 14;
	static constexpr int kKeyBits = 48;

	bool put(uint64_t packed)
	{
		const uint64_t entry = uint64_t{stamp_} << kKeyBits | packed;
		const size_t mask = slots_.size() - 1;
		for (size_t i = static_cast<size_t>(packed * 0x9E3779B97F4A7C15u >> (64 - bits_));; i = (i + 1) & mask)
		{
			if (slots_[i] == entry) return false;
			if (slots_[i] >> kKeyBits == stamp_) continue;
			slots_[i] = entry;
			return true;
		}
	}

	void grow()
	{
		std::vector<uint64_t> old(slots_.size() * 2);
		old.swap(slots_);
		++bits_;
		for (const uint64_t entry : old)
			if (entry >> kKeyBits == stamp_) put(entry & ((uint64_t{1} << kKeyBits) - 1));
	}

	std::vector<uint64_t> slots_;  //!< stamp of the scan above, voxel below
	int bits_;
	uint16_t stamp_ = 1;
	size_t count_ = 0;
};
}  // namespace viwo
