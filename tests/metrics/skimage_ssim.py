"""SSIM by scikit-image of pairs of raw float32 images, a line each: skimage_ssim.py WIDTH HEIGHT A B [A B]...
Wang et al.'s window and moments."""
import sys

import numpy
from skimage.metrics import structural_similarity

width, height = int(sys.argv[1]), int(sys.argv[2])
images = [numpy.fromfile(name, numpy.float32).reshape(height, width).astype(numpy.float64) for name in sys.argv[3:]]
for a, b in zip(images[::2], images[1::2]):
    print("%.12f" % structural_similarity(a, b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1))
