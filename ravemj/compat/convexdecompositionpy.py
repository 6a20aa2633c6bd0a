"""``openravepy.convexdecompositionpy``: convex parts of triangles; ``ravemj convert`` writes models with them."""

from ravemj.compat.refusal import refusing

computeConvexDecomposition = refusing("computeConvexDecomposition", "convex parts for scripts", "*arguments **named")
