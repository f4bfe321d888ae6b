# Tables of a bake: KTX2 files with raw texels, plain or compressed with zstd. The same file serves Godot 3.6 and 4.

const ZSTD = 2

# Formats of the manifest that Godot has, too.
const FORMATS = {
	"r16float": Image.FORMAT_RH,
	"rg16float": Image.FORMAT_RGH,
	"rgba16float": Image.FORMAT_RGBAH,
	"rgba8unorm": Image.FORMAT_RGBA8,
	"bc6h-rgb-ufloat": Image.FORMAT_BPTC_RGBFU,
	"r32float": Image.FORMAT_RF,
	"rgba32float": Image.FORMAT_RGBAF,
	# They become half floats; one of 10 bits is off by a quarter of its step at most.
	"rgb10a2unorm": Image.FORMAT_RGBAH,
	"rg11b10ufloat": Image.FORMAT_RGBAH,
}


# Width, height, format and texels of the first level of a file; null where the file is none, or is cut.
static func read(bytes, format):
	var file = StreamPeerBuffer.new()
	file.data_array = bytes
	if bytes.size() < 104 or file.get_u32() != 0x58544bab:
		return null
	var width = _u32(file, 20)
	var height = _u32(file, 24)
	var is_compressed = _u32(file, 44) == ZSTD
	var offset = _u64(file, 80)
	var length = _u64(file, 88)
	var whole = _u64(file, 96)
	file.seek(offset)
	var texels = file.get_data(length)[1]
	if is_compressed:
		texels = texels.decompress(whole, ZSTD)
	if texels.size() != whole:
		return null
	if format in ["rgb10a2unorm", "rg11b10ufloat"]:
		texels = _halves(texels, format)
	return [width, height, FORMATS[format], texels]


static func _u32(file, at):
	file.seek(at)
	return file.get_u32()


static func _u64(file, at):
	file.seek(at)
	return file.get_u64()


# Texels of 32 bits as half floats.
static func _halves(texels, format):
	var words = StreamPeerBuffer.new()
	words.data_array = texels
	var halves = StreamPeerBuffer.new()
	halves.resize(2 * texels.size())
	for i in range(texels.size() / 4):
		var word = words.get_u32()
		if format == "rgb10a2unorm":
			for channel in range(3):
				halves.put_u16(_half(((word >> (10 * channel)) & 1023) / 1023.0))
			halves.put_u16(_half((word >> 30) / 3.0))
		else:
			# A float of 11 or 10 bits is a half float without its sign and its last bits.
			halves.put_u16((word & 2047) << 4)
			halves.put_u16(((word >> 11) & 2047) << 4)
			halves.put_u16((word >> 22) << 5)
			halves.put_u16(_half(1.0))
	return halves.data_array


# Bits of the half float next to a number in 0..1.
static func _half(value):
	if value < pow(2.0, -14.0):
		return int(round(value * pow(2.0, 24.0)))
	var exponent = floor(log(value) / log(2.0))
	return int(round((exponent + 14.0 + value / pow(2.0, exponent)) * 1024.0))
