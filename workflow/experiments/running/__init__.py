"""What all experiments share: a contact under way, searches, trust, and what they hand over."""
