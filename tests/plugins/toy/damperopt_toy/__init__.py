"""Components of a gear that another distribution brings."""
